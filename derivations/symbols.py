"""The symbols of the derivations: one Python name, one LaTeX name and one unit for each quantity.

Axes: the static cable hangs in the x-z plane, z up, from the fixed end B (origin) to the moving end C.
The dynamic cable uses the chord as its x axis, z perpendicular to it in the vertical plane and up.
"""

import sympy as sp

force_x = sp.Symbol("force_x", real=True)
force_z = sp.Symbol("force_z", real=True)
s = sp.Symbol("s", nonnegative=True)
length = sp.Symbol("length", positive=True)
axial_stiffness = sp.Symbol("axial_stiffness", positive=True)
weight = sp.Symbol("weight", positive=True)

omega = sp.Symbol("omega", positive=True)
omega_c_squared = sp.Symbol("omega_c_squared")
damping_ratio = sp.Symbol("damping_ratio", nonnegative=True)
reference_omega = sp.Symbol("reference_omega", positive=True)
chord = sp.Symbol("chord", positive=True)
tension = sp.Symbol("tension", positive=True)
effective_length = sp.Symbol("effective_length", positive=True)
linear_density = sp.Symbol("linear_density", positive=True)
perpendicular_weight = sp.Symbol("perpendicular_weight", nonnegative=True)
epsilon = sp.Symbol("epsilon", nonnegative=True)
lambda2 = sp.Symbol("lambda2", nonnegative=True)
frequency_parameter = sp.Symbol("frequency_parameter", nonnegative=True)

rx, ry, rz = sp.symbols("rx ry rz", real=True)
ax, ay, az = sp.symbols("ax ay az", real=True)
fx, fy, fz = sp.symbols("fx fy fz", real=True)
cx, cy, cz = sp.symbols("cx cy cz", real=True)
mass = sp.Symbol("mass", positive=True)
ixx, iyy, izz = sp.symbols("ixx iyy izz", positive=True)
ixy, ixz, iyz = sp.symbols("ixy ixz iyz", real=True)

b = sp.Symbol("b", positive=True)
gravity = sp.Symbol("gravity", positive=True)

LATEX = {
    force_x: "f_{Cx}",
    force_z: "f_{Cz}",
    length: "l_{us}",
    axial_stiffness: "EA",
    weight: r"(\rho g)",
    omega: r"\omega",
    omega_c_squared: r"\omega_c^2",
    damping_ratio: r"\xi",
    reference_omega: r"\omega_1",
    chord: "l_c",
    tension: r"\tau",
    effective_length: "L_e",
    linear_density: r"\rho",
    perpendicular_weight: r"(\rho g\cos\alpha)",
    epsilon: r"\varepsilon",
    lambda2: r"\lambda^2",
    frequency_parameter: r"\Omega",
    rx: "r_x",
    ry: "r_y",
    rz: "r_z",
    ax: "a_x",
    ay: "a_y",
    az: "a_z",
    fx: "f_x",
    fy: "f_y",
    fz: "f_z",
    cx: "c_x",
    cy: "c_y",
    cz: "c_z",
    mass: "m",
    gravity: "g",
    ixx: "I_{xx}",
    iyy: "I_{yy}",
    izz: "I_{zz}",
    ixy: "I_{xy}",
    ixz: "I_{xz}",
    iyz: "I_{yz}",
}

MEANING = {
    "force_x": "[N] horizontal force on the cable at C; the cable runs from B towards +x for force_x > 0",
    "force_z": "[N] vertical force on the cable at C, up; at B it is force_z - weight*length",
    "s": "[m] unstrained coordinate from B (0) to C (length)",
    "length": "[m] unstrained length",
    "axial_stiffness": "EA [N]",
    "weight": "rho g [N/m], per unstrained length",
    "omega": "[rad/s]",
    "omega_c_squared": "[rad^2/s^2] real, or complex with damping (damped_omega_squared)",
    "damping_ratio": "xi [-], referred to reference_omega",
    "reference_omega": "omega_1 [rad/s], first natural frequency of the cable",
    "chord": "l_c [m]",
    "tension": "tau [N], static tension where the cable is parallel to its chord",
    "effective_length": "L_e [m]",
    "linear_density": "rho [kg/m]",
    "perpendicular_weight": "rho g cos(alpha) [N/m], weight component across the chord",
    "epsilon": "[-] perpendicular_weight*chord/tension",
    "lambda2": "lambda^2 [-]",
    "frequency_parameter": "Omega [-], omega*chord*sqrt(linear_density/tension)",
    "rx": "[rad] about x, applied first",
    "ry": "[rad] about y, applied second",
    "rz": "[rad] about z, applied last",
    "ax": "[m] arm from the reference point to the attachment",
    "ay": "[m]",
    "az": "[m]",
    "fx": "[N] constant force on the platform at the end of the arm",
    "fy": "[N]",
    "fz": "[N]",
    "mass": "[kg]",
    "cx": "[m] centre of mass from the reference point",
    "cy": "[m]",
    "cz": "[m]",
    "ixx": "[kg m^2] inertia tensor about the centre of mass",
    "iyy": "[kg m^2]",
    "izz": "[kg m^2]",
    "ixy": "[kg m^2] tensor element, -int(x y dm)",
    "ixz": "[kg m^2] tensor element, -int(x z dm)",
    "iyz": "[kg m^2] tensor element, -int(y z dm)",
    "b": "[rad/s] wanted lowest cable frequency",
    "gravity": "g [m/s^2]",
}
