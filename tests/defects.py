"""Known defects of rotational code: story, mutant, and the checks that kill it.

Thread numbers are GitHub's. The checks compare a mutant with the scene as it should be.
"""

from collections.abc import Callable
from dataclasses import dataclass

from derive.library.library import Library
from tests.check.mutants import (
    Texts,
    first_sign_flipped,
    half_forgotten,
    omega_for_Omega,
    ops_changed,
    other_program,
    other_scene,
    other_text,
    scalar_last,
    transposed,
    turns_swapped,
    without_gyroscopic_term,
    without_products,
)


@dataclass(frozen=True)
class Defect:
    """One way to be wrong: on which scene, made how, and which checks must see it."""

    name: str
    story: str
    scene: str
    mutant: Callable[[Library], Texts]
    killed_by: tuple[str, ...]


DEFECTS = (
    Defect(
        "gyroscopic term dropped",
        "omega x I omega was forgotten (ardupilot 26972, avian 420 ff.); energy never shows it",
        "free_body_principal",
        other_program("acceleration", ops_changed(without_gyroscopic_term)),
        ("error", "bits of the program"),
    ),
    Defect(
        "wrong sign",
        "a sign of the gyroscopic moment, and the reference had it too (crazyflow 86)",
        "free_body_principal",
        other_program("acceleration", first_sign_flipped),
        ("error", "cyclic relabelling", "power balance"),
    ),
    Defect(
        "wheel inertia counted twice",
        "the tensor of the whole, wheels locked, had the wheels added once more",
        "gyrostat",
        other_scene(('moments  = ["I_xx",', 'moments  = ["I_xx + C_1",')),
        ("error",),
    ),
    Defect(
        "only the diagonal used",
        "the products of inertia were read and never used (avian 420 ff.)",
        "free_body",
        other_program("moment", ops_changed(without_products)),
        ("error", "rotation of axes"),
    ),
    Defect(
        "frame order",
        "yaw, pitch, roll turned in another order than the one declared",
        "gyrostat",
        other_program("state_rate", ops_changed(turns_swapped)),
        ("error",),
    ),
    Defect(
        "quaternion order",
        "the scalar part was read last where it is written first",
        "rigid_body",
        other_program("state_rate", scalar_last),
        ("error", "power balance"),
    ),
    Defect(
        "half of the quaternion rate forgotten",
        "q' = q omega instead of q omega / 2",
        "rigid_body",
        other_program("state_rate", ops_changed(half_forgotten)),
        ("error",),
    ),
    Defect(
        "Omega and omega swapped",
        "an Omega x term with the wrong Omega, and the reference had it too (JSBSim 1034)",
        "rotor_on_turning_axes",
        other_program("moment", omega_for_Omega),
        ("error",),
    ),
    Defect(
        "product sign",
        "I_xy read as the tensor's entry where +sum x y dm is meant",
        "free_body",
        other_scene(('["I_xy", "I_xz", "I_yz"]', '["-I_xy", "-I_xz", "-I_yz"]')),
        ("error",),
    ),
    Defect(
        "transposed Jacobian",
        "nonzeros stored by rows under a pattern by columns",
        "free_body",
        other_program("acceleration_jacobian", transposed),
        ("error", "bits of the program"),
    ),
    Defect(
        "whole matrix by rows",
        "a dense Jacobian filled by rows where columns are promised",
        "free_body_principal",
        other_text("_f64.c", ("jacobian[places[entry]]", "jacobian[places[entry] / 2]")),
        ("whole matrix",),
    ),
    Defect(
        "stale set-up constant",
        "a constant of an earlier body was left standing",
        "free_body_principal",
        other_text("_f64.c", ("constants->I_yy_minus_I_zz = s3.high", "(void)s3")),
        ("error", "bits of the program", "CasADi's bits"),
    ),
    Defect(
        "set-up in working precision",
        "the inverse loses what its condition takes (PyDy on a rod: 9e4 u)",
        "free_body",
        other_text("_f64.c", ("constants->J_xx = ", "constants->J_xx = (double)(float)")),
        ("error", "CasADi's bits"),
    ),
    Defect(
        "double literal in a float file",
        "float code that computes in double, 6.6 times slower (sympy 14063, zephyr 38958)",
        "free_body_principal",
        other_text("_f32.c", ("omega_y_in * omega_z_in", "omega_y_in * 1.0 * omega_z_in")),
        ("compiles without warnings",),
    ),
    Defect(
        "float literal in a double file",
        "0.1F where 0.1 is meant: nine digits lost without a warning",
        "rigid_body",
        other_text("_f64.c", ("* 0.5;", "* 0.500000003F;")),
        ("compiles without warnings",),
    ),
    Defect(
        "an input read after a result is stored",
        "omega_dot written over omega gave a wrong result without a word (C made by CasADi)",
        "free_body_principal",
        other_text("_f64.c", ("omega_z_in * omega_x_in", "omega_z_in * omega[0]")),
        ("outputs over inputs",),
    ),
    Defect(
        "cancellation near a sphere",
        "I_zz w_z w_y - I_yy w_y w_z as two products: nothing is left of two nearly equal moments",
        "free_body_principal",
        other_text(
            "_f64.c",
            (
                "t0 * constants->I_yy_minus_I_zz;",
                "omega_z_in * constants->I_yy * t0 - t0 * constants->I_zz * omega_z_in;",
            ),
            ("t0 = omega_y_in * omega_z_in;", "t0 = omega_y_in;"),
        ),
        ("near a sphere",),
    ),
    Defect(
        "CasADi's file edited by hand",
        "generator and flown code drifted apart (ardupilot 27862, 31949)",
        "free_body_principal",
        other_text("_casadi.py", ("omega[1] * omega[2]", "omega[2] * omega[2]")),
        ("CasADi's bits",),
    ),
    Defect(
        "wrong sparsity",
        "a pattern that is not the one of the numbers gives a silently wrong Jacobian",
        "free_body_principal",
        other_text("_casadi.py", ("[1, 2, 0, 2, 0, 1, 0, 1, 2]", "[0, 2, 0, 2, 0, 1, 0, 1, 2]")),
        ("sparsity",),
    ),
    Defect(
        "files of another scene",
        "what is called is not what was declared (PX4-Autopilot 20333: copied by hand)",
        "free_body",
        other_scene(('["I_xy", "I_xz", "I_yz"]', "[0, 0, 0]")),
        ("describes the scene's functions",),
    ),
    Defect(
        "a body that is none",
        "set-up that accepts a tensor which is not positive definite",
        "free_body_principal",
        other_text("_f64.c", ("return 4", "return 0")),
        ("refuses what is no body",),
    ),
    Defect(
        "a body without end",
        "set-up that takes an infinite moment, whose reciprocal is a harmless 0",
        "free_body_principal",
        other_text("_f64.c", ("!(I_xx - I_xx >= 0.0)", "0")),
        ("refuses what is no body",),
    ),
)
