"""Of the page's model, saved as page.py: the turn solved by CasADi, as acados reads its fields."""

from page import N, ca, craft, end, h, inertia, np, quiet, start

x, u, pi = craft.x, craft.u, craft.pi
slopes = [craft.disc_dyn_expr, craft.disc_dyn_custom_jac_ux_expr]
step = ca.Function("step", [x, u, craft.p], slopes)
bent = ca.Function("bent", [x, u, pi, craft.p], [craft.disc_dyn_custom_hess_ux_expr])
WIDE = 10  # u, then x, of each stage; the last has no u
w, lam = ca.MX.sym("w", N * WIDE + 7), ca.MX.sym("lam", 7 * N)
lam_f, none = ca.MX.sym("lam_f"), ca.MX.sym("p", 0)
begins = [*range(3, N * WIDE, WIDE), N * WIDE]  # of the states
stages = [w[k * WIDE : k * WIDE + WIDE] for k in range(N)]
each = [step(s[3:], s[:3], inertia) for s in stages]
bends = [bent(s[3:], s[:3], lam[7 * k : 7 * k + 7], inertia) for k, s in enumerate(stages)]
gaps = ca.vertcat(*(w[b : b + 7] - e[0] for b, e in zip(begins[1:], each, strict=True)))
J = ca.MX(7 * N, N * WIDE + 7)
for k, (_, by_ux) in enumerate(each):
    rows, after = slice(7 * k, 7 * k + 7), begins[k + 1]
    J[rows, k * WIDE : k * WIDE + WIDE] = -by_ux
    J[rows, after : after + 7] = ca.DM.eye(7)
moments = ca.DM(([1] * 3 + [0] * 7) * N + [0] * 7)
H = 2 * h * lam_f * ca.diag(moments) - ca.diagcat(*bends, ca.MX(7, 7))
given = {
    "jac_g": ca.Function("jac_g", [w, none], [gaps, J], ["x", "p"], ["g", "jac_g_x"]),
    "hess_lag": ca.Function(
        "hess_lag",
        [w, none, lam_f, lam],
        [ca.triu(H)],
        ["x", "p", "lam_f", "lam_g"],
        ["triu_hess_gamma_x_x"],
    ),
}
problem = {"x": w, "f": h * ca.dot(moments * w, w), "g": gaps}
solver = ca.nlpsol("turn", "ipopt", problem, quiet | given)
free = np.tile([0.4] * 3 + [np.inf] * 7, N)
low, high = (np.array([*(s * free), s * np.inf, *end]) for s in (-1, 1))
low[3:10] = high[3:10] = start
found = solver(x0=[*([0, 0, 0, *start] * N), *start], lbx=low, ubx=high, lbg=0, ubg=0)
print(f"{float(found['f']):.5f} N^2 m^2 s", solver.stats()["success"])
