"""How to read a verification, and how it was computed."""

from cdpr_struct.crosscheck.verification import Verification


def verification_notes(trial: Verification) -> list[tuple[str, list[str]]]:
    """Headings with their paragraphs."""
    criteria, elements = trial.criteria, ", ".join(map(str, trial.elements))
    return [
        (
            "How to read this",
            [
                "A cable robot vibrates in two ways. In platform modes the platform moves on its cables as on springs; in "
                "cable modes the cables swing like strings and the platform hardly moves; mixed modes are both. The "
                "dynamic stiffness method (DSM) describes each cable by one closed formula and so finds both kinds; "
                "the finite-element method (FEM) cuts each cable into many short elements and assumes far less. "
                "Where the two agree, the formula may be trusted.",
                f"The verdict holds if every FEM frequency has a DSM partner within {100.0 * criteria.relative_error:g} %, "
                f"of which it shares at least {criteria.assurance:g} of its shape, the FEM is itself certain to "
                f"{100.0 * criteria.fem_uncertainty:g} %, and the number of DSM frequencies is certified by counting. "
                "The validity limits and the determinant scan are reported beside it and do not decide it.",
            ],
        ),
        (
            "How it was computed",
            [
                f"FEM: straight two-node bar elements with lumped mass, {elements} per cable, a static equilibrium of its own "
                "at the same unstrained lengths, eigenfrequencies extrapolated in the element count. It shares no formula "
                "with the DSM.",
                "DSM: closed-form cable stiffness of the thesis (eqs 2.31 to 2.46); natural frequencies by counting "
                "(Wittrick-Williams) and bisection, so that none is missed, undamped. Modes are paired by shape, not by order. "
                f"Assembly {trial.assembly}: "
                + (
                    "with the geometric stiffness of the static cable forces at the turning platform."
                    if trial.assembly == "consistent"
                    else "eq. (3.8) as printed, without the geometric stiffness of the turning platform."
                ),
                f"Determinant scan: the thesis's method, with viscous cable damping, in steps of {trial.scan.step_hertz:g} Hz; a "
                f"minimum stands for a mode within {criteria.minimum_tolerance:g} Hz, and for one mode only.",
                "Assumed throughout: linear elastic cables without bending stiffness, a rigid platform, fixed frame anchors, "
                "winches that hold the unstrained lengths, small vibrations about the rest pose, tensions of minimum norm.",
            ],
        ),
    ]
