"""How to read a verification, and how it was computed."""

from cdpr_struct.crosscheck.verification import Verification


def verification_notes(trial: Verification) -> list[tuple[str, list[str]]]:
    """Headings with their paragraphs."""
    return [
        ("How to read this", [_MODES_AND_METHODS, _criteria(trial)]),
        ("How it was computed", [_fem(trial), _dsm(trial), _scan(trial), _ASSUMPTIONS]),
    ]


_MODES_AND_METHODS = (
    "A cable robot vibrates in two ways. In platform modes the platform moves on its cables as on springs; in "
    "cable modes the cables swing like strings and the platform hardly moves; mixed modes are both. The dynamic "
    "stiffness method (DSM) describes each cable by one closed formula and so finds both kinds; the finite-element "
    "method (FEM) cuts each cable into many short elements and assumes far less. Where the two agree, the formula "
    "may be trusted."
)
_ASSUMPTIONS = (
    "Assumed throughout: linear elastic cables without bending stiffness, a rigid platform, fixed frame anchors, "
    "winches that hold the unstrained lengths, small vibrations about the rest pose."
)
_ASSEMBLIES = {
    "consistent": "with the geometric stiffness of the static cable forces at the turning platform",
    "thesis": "eq. (3.8) as printed, without the geometric stiffness of the turning platform",
}


def _criteria(trial: Verification) -> str:
    criteria = trial.criteria
    return (
        f"The verdict holds if every FEM frequency has a DSM partner within {100.0 * criteria.relative_error:g} %, "
        f"of which it shares at least {criteria.assurance:g} of its shape, the FEM is itself certain to "
        f"{100.0 * criteria.fem_uncertainty:g} %, and the number of DSM frequencies is certified by counting. The "
        "validity limits and the determinant scan are reported beside it and do not decide it."
    )


def _fem(trial: Verification) -> str:
    return (
        f"FEM: straight two-node bar elements with lumped mass, {', '.join(map(str, trial.elements))} per cable, a "
        "static equilibrium of its own at the same unstrained lengths, eigenfrequencies extrapolated in the "
        "element count. It shares no formula with the DSM."
    )


def _dsm(trial: Verification) -> str:
    return (
        "DSM: closed-form cable stiffness of the thesis (eqs 2.31 to 2.46), undamped; natural frequencies by "
        "counting (Wittrick-Williams) and bisection, so that none is missed. Modes are paired by shape, not by "
        f"order. Assembly {trial.assembly}: {_ASSEMBLIES[trial.assembly]}."
    )


def _scan(trial: Verification) -> str:
    return (
        f"Determinant scan: the thesis's method, with viscous cable damping, in steps of {trial.scan.step_hertz:g} "
        f"Hz; a minimum stands for a mode within {trial.criteria.minimum_tolerance:g} Hz, and for one mode only."
    )
