from derivations import cable_dsm_stable as d, platform as p
from derivations.records import GeneratedFunction as G
from derivations.print_python import module_text
from derivations.symbols import *
a7=(omega_c_squared, chord, tension, axial_stiffness, effective_length, linear_density, perpendicular_weight)
sp_I=__import__("sympy").I
fs=[G("dynamic_stiffness",a7,d.dynamic_stiffness(),"(k_xx, k_xz, k_yy, k_zz) [N/m], chord frame, x from B to C, z perpendicular and up.","s",()),
G("lambda_squared",(chord,tension,axial_stiffness,effective_length,perpendicular_weight),(d.irvine_parameter(),),"r","s",()),
G("epsilon",(chord,tension,perpendicular_weight),(d.sag_ratio(),),"r","s",()),
G("effective_length_integral",(chord,epsilon),(d.effective_length_integral(),),"r","s",()),
G("effective_length_approximation",(chord,epsilon),(d.effective_length_approximation(),),"r","s",()),
G("damped_omega_squared",(omega,damping_ratio,reference_omega),(omega**2-2*sp_I*damping_ratio*reference_omega*omega,),"r","s",()),
G("clamped_frequency_function",(frequency_parameter,lambda2),(d.clamped_frequency_function(),),"r","s",()),
]
open("cdpr_struct/generated/cable_dsm.py","w").write(module_text("x",tuple(fs)))
m=lambda n,a,M:G(n,a,tuple(M),"r","s",(),tuple(M.shape))
A,F,C=(ax,ay,az),(fx,fy,fz),(cx,cy,cz)
fs=[m("rotation",(rx,ry,rz),p.rotation()),m("attachment",A,p.attachment()),m("attachment_printed",A,p.attachment_printed()),
m("geometric_stiffness",F+A,p.geometric_stiffness()),m("mass_matrix",(mass,*C,ixx,iyy,izz,ixy,ixz,iyz),p.mass_matrix())]
open("cdpr_struct/generated/platform.py","w").write(module_text("x",tuple(fs)))
from sympy import pi
fs=[G("lower_bound_printed",(b,linear_density,gravity,length),(b**2/pi**2*linear_density*gravity*length,),"r","s",()),
G("lower_bound_frequency",(b,linear_density,length),(linear_density*(b*length/pi)**2,),"r","s",())]
open("cdpr_struct/generated/tension_bound.py","w").write(module_text("x",tuple(fs)))
