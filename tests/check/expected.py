"""The seventeen machines of the data file: their data in SI units, and where each answer stands."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import atan, pi, radians, tan
from pathlib import Path
from typing import Any

SCENES = json.loads(
    (Path(__file__).parents[1] / "data" / "scenes.json").read_text(encoding="utf-8")
)
DATA: Mapping[str, Any] = {scene["name"]: scene for scene in SCENES}
RPM = 2 * pi / 60

Values = dict[str, float]


def same(x: float) -> float:
    return x


@dataclass(frozen=True)
class Answer:
    """An expected number: the function and component that give it, and what is made of that."""

    expected: str
    function: str
    component: str
    made: Callable[[float], float] = same
    extra: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Case:
    """A machine of the data file, its values, and its answers."""

    scene: str
    values: Values
    answers: tuple[Answer, ...]

    def expected(self, name: str) -> float:
        return float(DATA[self.scene]["expected"][name])


def plain(function: str, *names: str) -> tuple[Answer, ...]:
    return tuple(Answer(name, function, name) for name in names)


def each(*names: str) -> tuple[Answer, ...]:
    return tuple(Answer(name, name, name) for name in names)


def data(name: str, *left_out: str) -> Values:
    """Return the data that are plain numbers, but those left out."""
    found = DATA[name]["data"]
    return {
        k: float(v) for k, v in found.items() if isinstance(v, int | float) and k not in left_out
    }


EDGE = Case("edge_runner_flat", data("edge_runner_flat"),
            each("spin_rel", "N", "gyro_gain", "hinge_radial", "hinge_z"))  # fmt: skip

_cone = data("rolling_cone", "half_angle_deg")
_a = radians(DATA["rolling_cone"]["data"]["half_angle_deg"])
CONE = Case("rolling_cone", _cone | {"a": _a, "r": _cone["h"] * tan(_a)},
            (Answer("T", "kinetic_energy", "kinetic_energy"), *each("x_N")))  # fmt: skip

_disk = data("eulers_disk", "tilt_rad")
DISK = Case("eulers_disk", _disk | {"tilt": DATA["eulers_disk"]["data"]["tilt_rad"],
                                    "W": float(DATA["eulers_disk"]["expected"]["W"])},
            (*each("spin_rel"), Answer("moment", "tipping", "tipping")))  # fmt: skip

_port = DATA["ship_turbine_turn_port"]["data"]
PORT = Case("ship_turbine_turn_port",
            {"m": _port["m"], "k": _port["k_axial"], "p": _port["rpm"] * RPM, "a": _port["a_fwd"],
             "b": _port["b_aft"], "R": _port["turn_radius"], "v": _port["v"], "g": _port["g"]},
            (*each("gyro_moment"), *plain("reactions", "R_A", "R_B")))  # fmt: skip

_three = DATA["ship_turbine_three_motions"]["data"]
THREE = Case("ship_turbine_three_motions",
             {k: float(_three[k]) for k in ("m", "ws", "roll", "turn", "pitch", "a", "b", "g")}
             | {"kz": _three["kz_axial"]},
             (*plain("roll_case", "A_roll", "B_roll"), *plain("turn_case", "A_turn", "B_turn"),
              *plain("pitch_case", "A_pitch", "B_pitch"),
              *each("pitch_horizontal_couple")))  # fmt: skip

_disc = DATA["disc_two_bearings"]["data"]
DISC = Case("disc_two_bearings",
            {"m": _disc["m"], "r": _disc["r"], "w": _disc["rpm"] * RPM,
             "W": _disc["precession_rpm"] * RPM, "d": _disc["bearing_distance"], "g": _disc["g"]},
            each("couple", "R_up", "R_down"))  # fmt: skip

_blade = DATA["propeller_3_blade"]["data"]
BLADES = Case("propeller_3_blade",
              {"blade_mass": _blade["blade_mass"], "blade_length": _blade["blade_length"],
               "p": _blade["rpm"] * RPM, "W": _blade["W"]},
              (*plain("M", "M_x", "M_y", "M_z"), Answer("mean_My", "M", "M_y"),
               Answer("peak_My", "M", "M_y")))  # fmt: skip

_skew = DATA["skewed_disc"]["data"]
SKEW = Case("skewed_disc",
            {"m": _skew["m"], "r": _skew["r"], "skew": radians(_skew["skew_deg"]),
             "b": _skew["bearing_offset"], "w": _skew["rpm"] * RPM},
            (*plain("M", "M_x", "M_y", "M_z"), *each("bearing_force")))  # fmt: skip

_rod = DATA["rod_wire_vertical_shaft"]["data"]
ROD = Case("rod_wire_vertical_shaft",
           {"W": _rod["W_lb"], "L": _rod["L_ft"], "beta": radians(_rod["beta_deg"]),
            "w": _rod["w"], "g": _rod["g"]},
           each("T", "A_x", "A_z"))  # fmt: skip

_top = DATA["top_steady_precession"]["data"]
TOP = Case("top_steady_precession",
           {"m": _top["m"], "r": _top["r"], "l": _top["l"], "theta": radians(_top["theta_deg"]),
            "n": _top["omega3"], "g": _top["g"]}, ())  # fmt: skip

_sleep = DATA["sleeping_top"]
_spin = 1.5 * float(_sleep["expected"]["n_crit"])
SLEEP = Case("sleeping_top", data("sleeping_top") | {"n": _spin}, ())

_gyro = DATA["gyrocompass"]["data"]
GYRO = Case("gyrocompass",
            {"m": _gyro["m"], "r": _gyro["r"], "w3": _gyro["rpm_omega3"] * RPM,
             "lat": radians(_gyro["latitude_deg"]), "we": _gyro["earth_rate"], "alpha": 0.3},
            (*each("period_s"),
             Answer("alpha_acc_at_0p3", "alpha_ddot", "alpha_ddot")))  # fmt: skip

_sat = DATA["reaction_wheel_satellite"]["data"]
_J = _sat["J_total_locked"]
WHEELS = Case(
    "reaction_wheel_satellite",
    {"J_xx": _J[0][0], "J_yy": _J[1][1], "J_zz": _J[2][2], "J_xy": -_J[0][1], "J_xz": -_J[0][2],
     "J_yz": -_J[1][2], "I_w": _sat["Iw_axial"]}
    | dict(zip(("w_x", "w_y", "w_z"), _sat["w"], strict=True))
    | dict(zip(("s_1", "s_2", "s_3"), _sat["wheel_speeds"], strict=True))
    | dict(zip(("u_1", "u_2", "u_3"), _sat["motor_torque_on_wheel"], strict=True)),
    (*(Answer(f"w_dot_{a}", "body", f"w_{a}_dot") for a in "xyz"),
     *(Answer(f"wheel_acc_{n}", "wheels", f"s_{n}_dot") for n in (1, 2, 3))),
)  # fmt: skip

_free = DATA["torque_free_axisymmetric"]["data"]
FREE = Case("torque_free_axisymmetric",
            {"A": _free["A"], "C": _free["C"], "w_x": 0.0, "w_y": _free["w_transverse"],
             "w_z": _free["w_axial"]},
            (*each("precession", "body_rate", "L"), Answer("theta", "tan_theta", "tan_theta", atan),
             Answer("beta", "tan_beta", "tan_beta", atan)))  # fmt: skip

_earth = DATA["chandler_rigid_earth"]["data"]
EARTH = Case("chandler_rigid_earth",
             {"A": _earth["A"], "C": _earth["C"], "rate": _earth["earth_rate"]},
             each("period_days"))  # fmt: skip

_arm = DATA["centrifuge_gondola"]["data"]
ARM = Case(
    "centrifuge_gondola",
    {"m": _arm["m"], "I_xx": _arm["J_G"][0][0], "I_yy": _arm["J_G"][1][1],
     "I_zz": _arm["J_G"][2][2], "I_xz": -_arm["J_G"][0][2], "e_x": _arm["r_PG"][0],
     "e_z": _arm["r_PG"][2], "a_x": _arm["a_P"][0], "a_y": _arm["a_P"][1]}
    | {f"{name}{dots}": value for name in ("yaw", "pitch", "spin")
       for dots, value in zip(("", "_dot", "_ddot"), _arm[name], strict=True)},
    (*plain("F", "F_x", "F_y", "F_z"), *plain("M", "M_x", "M_y", "M_z")),
)  # fmt: skip

CASES = (EDGE, CONE, DISK, PORT, THREE, DISC, BLADES, SKEW, ROD, TOP, SLEEP, GYRO, WHEELS, FREE,
         EARTH, ARM)  # fmt: skip

_handle = DATA["t_handle_flip"]["data"]
HANDLE_START = (
    dict(zip(("I_xx", "I_yy", "I_zz"), _handle["I"], strict=True))
    | dict(zip(("omega_x", "omega_y", "omega_z"), _handle["w0"], strict=True))
    | {"attitude_w": 1.0, "attitude_x": 0.0, "attitude_y": 0.0, "attitude_z": 0.0}
)
HANDLE_TIMES = {"t2": 2.0, "t5": 5.0, "t60": 60.0}


def handle_expected(name: str) -> float:
    return float(DATA["t_handle_flip"]["expected"][name])
