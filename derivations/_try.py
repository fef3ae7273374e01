import mpmath as mp, numpy as np, sympy as sp, importlib.util, random
from derivations import catenary_stable as cs
from derivations.records import GeneratedFunction as G
from derivations.print_python import module_text, header
from derivations.print_special_functions import module_body
from derivations.symbols import *
open("cdpr_struct/generated/special_functions.py","w").write(header("derivations/special_functions.py", None)+module_body())
c=cs.whole_cable()
args=(force_x,force_z,length,axial_stiffness,weight)
V0=force_z-weight*length; w=weight
piece=cs.segment(force_x,weight,s,axial_stiffness,V0,force_z-weight*(length-s))
fs=[G("end_point",args,cs.end_point(c),"x","s",()),G("profile",(s,*args),cs.end_point(piece),"p","s",()),
G("elongation",args,(cs.elongation(c),),"e","s",()),G("chord_tension",args,(cs.chord_tension(c),),"e","s",()),
G("chord_parallel_coordinate",args,(cs.chord_parallel_coordinate(c),),"e","s",()),
G("sag",args,(cs.sag(c),),"e","s",())]
open("cdpr_struct/generated/catenary.py","w").write(module_text("x",tuple(fs)))
k=cs.sag_compliance(c)
fs=[G("compliance",args,(length/axial_stiffness,*k),"x","s",()),G("stiffness",args,cs.stiffness(c),"x","s",())]
open("cdpr_struct/generated/cable_compliance.py","w").write(module_text("x",tuple(fs)))
