"""What acados' Python package calls the fields of a model, and no more: a stand-in for it.

Recorded from interfaces/acados_template/acados_template/acados_model.py of acados/acados at
21376cb1af6b7dd45f675367272d3ba8100b26c0, of August 2026; those of costs and constraints left out.
"""


class AcadosModel:
    """A model with these fields: any other is an AttributeError."""

    __slots__ = (
        "disc_dyn_custom_hess_ux_expr",
        "disc_dyn_custom_jac_ux_expr",
        "disc_dyn_expr",
        "f_expl_expr",
        "f_impl_expr",
        "name",
        "p",
        "p_global",
        "pi",
        "t",
        "t_label",
        "u",
        "u_labels",
        "x",
        "x_labels",
        "xdot",
        "z",
    )
