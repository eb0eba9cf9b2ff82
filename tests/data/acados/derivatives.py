"""Of the page's model, saved as page.py: whether derivatives and rates are as acados has them."""

from page import ca, craft, inertia, np

x, u, pi, p = craft.x, craft.u, craft.pi, craft.p
ux = ca.vertcat(u, x)
after = craft.disc_dyn_expr
given = [craft.disc_dyn_custom_jac_ux_expr, craft.disc_dyn_custom_hess_ux_expr]
own = ca.Function("own", [x, u, pi, p], given)
exact = [ca.jacobian(after, ux), ca.hessian(ca.dot(pi, after), ux)[0]]
theirs = ca.Function("theirs", [x, u, pi, p], exact)
dice = np.random.default_rng(1)
at = [dice.normal(size=7), dice.normal(size=3), dice.normal(size=7), inertia]
gaps = [float(ca.norm_inf(ca.vec(a - b))) for a, b in zip(own(*at), theirs(*at), strict=True)]
print("derivatives by u and x:", max(gaps) < 1e-13)
rates = ca.Function("rates", [x, u, craft.xdot, p], [craft.f_impl_expr, craft.f_expl_expr])
left, rate = rates(at[0], at[1], 1, inertia)
print("rates:", float(ca.norm_inf(left + rate - 1)) < 1e-15, craft.x_labels[4], craft.u_labels[2])
