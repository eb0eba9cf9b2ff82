"""Of the page's model, saved as page.py: the turn solved by acados' Python package, on CasADi."""

from acados_template import AcadosCasadiOcpSolver, AcadosOcp
from page import N, ca, craft, end, h, inertia, np, quiet, start

ocp = AcadosOcp()
ocp.model, ocp.parameter_values = craft, np.array(inertia)
ocp.solver_options.N_horizon, ocp.solver_options.tf = N, N * h
ocp.solver_options.integrator_type, ocp.solver_options.hessian_approx = "DISCRETE", "EXACT"
ocp.cost.cost_type, craft.cost_expr_ext_cost = "EXTERNAL", ca.sumsqr(craft.u)
ocp.constraints.idxbu, ocp.constraints.idxbx_e = np.arange(3), np.arange(1, 7)
ocp.constraints.lbu, ocp.constraints.ubu = np.full(3, -0.4), np.full(3, 0.4)
ocp.constraints.lbx_e = ocp.constraints.ubx_e = np.array(end)
ocp.constraints.x0 = np.array(start, dtype=float)
solver = AcadosCasadiOcpSolver(ocp, casadi_solver_opts=quiet | {"record_time": True})
print("status", solver.solve(), f"{solver.get_cost():.5f} N^2 m^2 s")
