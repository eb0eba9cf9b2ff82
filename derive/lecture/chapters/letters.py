"""The letters of the lecture, each in one place, with its meaning and its unit."""

from __future__ import annotations

from dataclasses import dataclass

from derive.lecture.vectors import Expression, inertia, scalar, tensor, unit, vector


@dataclass(frozen=True)
class Letter:
    """One row of the table of symbols."""

    symbol: Expression
    says: str
    si_unit: str

    @property
    def name(self) -> str:
        """Return the name of the symbol in the lecture."""
        return self.symbol.name


e_x, e_y, e_z = unit("x"), unit("y"), unit("z")

# One particle i, another particle j.
dm, r, r_j, v, a_i = scalar("dm_i"), vector("r_i"), vector("r_j"), vector("v_i"), vector("a_i")
rho, rho_dot = vector("rho_i"), vector("rho_i_dot")
rho_N_dot, rho_N_ddot = vector("rho_i_N_dot"), vector("rho_i_N_ddot")
F_i, f_i, P_ij, P_ji = vector("F_i"), vector("f_i"), vector("P_ij"), vector("P_ji")
p_ij = scalar("p_ij")

# Points, and the body as a whole.
r_A, v_A, a_A = vector("r_A"), vector("v_A"), vector("a_A")
r_G, v_G, a_G, rho_G = vector("r_G"), vector("v_G"), vector("a_G"), vector("rho_G")
m, F, M, T = scalar("m"), vector("F"), vector("M"), scalar("T")
l, l_dot, l_N_dot = vector("l"), vector("l_dot"), vector("l_N_dot")  # noqa: E741
I, I_dot = inertia("I"), inertia("I_dot")  # noqa: E741

# Turning.
b, Q, Q_dot = vector("b_i"), tensor("Q"), tensor("Q_dot")
omega, omega_dot = vector("omega"), vector("omega_dot")
Omega, Omega_dot = vector("Omega"), vector("Omega_dot")
R, R_dot = tensor("R"), tensor("R_dot")
q_w, q_v = scalar("q_w"), vector("q_v")
q_w_dot, q_v_dot = scalar("q_w_dot"), vector("q_v_dot")
s, s_dot, A, C, e = scalar("s"), scalar("s_dot"), scalar("A"), scalar("C"), vector("e")
n, w = vector("n"), vector("w")

# The wheels of a gyrostat.
h, h_dot, a, u, d = vector("h"), vector("h_dot"), vector("a"), scalar("u"), vector("d")

LETTERS = (
    Letter(dm, "mass of particle i", "kg"),
    Letter(r, "position of particle i from a point fixed in N", "m"),
    Letter(v, "velocity of particle i seen from N", "m/s"),
    Letter(a_i, "acceleration of particle i seen from N", "m/s^2"),
    Letter(rho, "position of particle i from the point A", "m"),
    Letter(F_i, "external force on particle i", "N"),
    Letter(P_ij, "force on particle i from particle j", "N"),
    Letter(m, "mass of the body", "kg"),
    Letter(rho_G, "position of the centre of mass G from A", "m"),
    Letter(v_G, "velocity of G seen from N", "m/s"),
    Letter(a_G, "acceleration of G seen from N", "m/s^2"),
    Letter(a_A, "acceleration of A seen from N", "m/s^2"),
    Letter(F, "sum of the external forces", "N"),
    Letter(M, "moment of the external forces about A", "N m"),
    Letter(l, "angular momentum about A", "kg m^2/s"),
    Letter(l_N_dot, "rate of l seen from N", "N m"),
    Letter(l_dot, "rate of l seen from the axes xyz", "N m"),
    Letter(I, "inertia tensor about A along xyz", "kg m^2"),
    Letter(I_dot, "rate of I seen from the axes xyz", "kg m^2/s"),
    Letter(T, "kinetic energy", "J"),
    Letter(omega, "angular velocity of the body in N", "rad/s"),
    Letter(omega_dot, "rate of omega seen from the axes xyz", "rad/s^2"),
    Letter(Omega, "angular velocity of the axes xyz in N", "rad/s"),
    Letter(Omega_dot, "rate of Omega seen from the axes xyz", "rad/s^2"),
    Letter(R, "turns components along xyz into components along N", "1"),
    Letter(q_w, "scalar part of the unit quaternion, body to N", "1"),
    Letter(q_v, "vector part of the unit quaternion, body to N", "1"),
    Letter(A, "transverse moment of inertia of an axisymmetric body", "kg m^2"),
    Letter(C, "axial moment of inertia of an axisymmetric body or wheel", "kg m^2"),
    Letter(a, "unit vector along a wheel's axis", "1"),
    Letter(s, "spin speed relative to the axes or to the carrier", "rad/s"),
    Letter(u, "motor torque on a wheel about its axis", "N m"),
    Letter(h, "angular momentum of the wheels relative to the carrier", "kg m^2/s"),
)
