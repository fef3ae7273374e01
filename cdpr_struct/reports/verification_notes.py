"""How to read a verification, and how it was computed."""

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.verification_verdict import MODEL_WORDS


def verification_notes(trial: Verification) -> list[tuple[str, list[str]]]:
    """Headings with their paragraphs."""
    return [
        ("How to read this", [_MODES_AND_METHODS, _criteria(trial)]),
        ("How it was computed", [_fem(trial), _dsm(trial), _CAUSES, _scan(trial), _ASSUMPTIONS]),
    ]


_MODES_AND_METHODS = (
    "A cable robot vibrates in two ways. In platform modes the platform moves on its cables as on springs; in "
    "cable modes the cables swing like strings and the platform hardly moves; mixed modes are both. The exact model, "
    "which all commands use by default, takes each cable as the elastic catenary that it is. The closed-form dynamic "
    "stiffness (DSM) is one formula for a taut cable between two fixed points. The finite-element method (FEM) cuts "
    "each cable into many short elements, and shares no formula with either: it judges both."
)
_ASSUMPTIONS = (
    "Assumed throughout: linear elastic cables without bending stiffness, a rigid platform, "
    "winches that hold the unstrained lengths, small vibrations about the rest pose."
)
_CAUSES = (
    "Cause of a deviation: the effects that a model leaves out (pulleys, stretch at rest, inertia and weight along the "
    "chord) are left out of the exact model as well, alone and together. The fewest without which all failing modes "
    "meet the tolerance are named, with the deviation that remains; what remains without all of them is sag."
)
_ASSEMBLIES = {
    "consistent": "with the geometric stiffness of the static cable forces at the turning platform",
    "thesis": "eq. (3.8) as printed, without the geometric stiffness of the turning platform",
}


def _criteria(trial: Verification) -> str:
    criteria = trial.criteria
    tolerances = " and ".join(
        f"{100.0 * criteria.tolerance(model):g} % ({MODEL_WORDS[model]})" for model in trial.judged
    )
    return (
        f"A model holds if every FEM frequency has a partner within {tolerances}, of which it shares at least "
        f"{criteria.assurance:g} of its shape, the FEM is itself certain to {criteria.fem_share:g} of that, and the "
        "number of the model's frequencies is certified by counting. The exit code and the colour are those of the "
        f"{MODEL_WORDS[trial.judged[0]]}. The validity limits and the determinant scan are reported beside it and do "
        "not decide it."
    )


def _fem(trial: Verification) -> str:
    return (
        f"FEM: straight two-node bar elements with lumped mass, {', '.join(map(str, trial.elements))} per cable, a "
        "static equilibrium of its own at the same unstrained lengths, eigenfrequencies extrapolated in the "
        "element count. Pulleys, masts and guides of the robot are in it. It shares no formula with the models."
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
