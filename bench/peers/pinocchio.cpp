// Pinocchio's articulated bodies on CasADi's symbols: AXES GRAVITY (13 numbers a body) FILE.
// Of each body: where its hinge is, its mass, its centre, moments and products about it.
#include <pinocchio/autodiff/casadi.hpp>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/multibody.hpp>

#include <casadi/casadi.hpp>
#include <string>
#include <vector>

namespace pin = pinocchio;
using SX = casadi::SX;
using Inertia = pin::InertiaTpl<SX>;

int main(int count, char **words)
{
    const std::string axes = words[1];
    std::vector<SX> given;
    for (int k = 2; k < count - 1; k++) { given.push_back(SX(std::stod(words[k]))); }
    pin::ModelTpl<SX> model;
    model.gravity.linear() << SX(0), SX(0), -given[0];
    pin::JointIndex at = 0;
    for (std::size_t k = 0; k < axes.size(); k++) {
        const SX *own = &given[1 + 13 * k];
        pin::SE3Tpl<SX> place = pin::SE3Tpl<SX>::Identity();
        place.translation() << own[0], own[1], own[2];
        at = axes[k] == 'x' ? model.addJoint(at, pin::JointModelRevoluteTpl<SX, 0, 0>(), place, "")
                            : model.addJoint(at, pin::JointModelRevoluteTpl<SX, 0, 1>(), place, "");
        Inertia::Vector3 centre;
        Inertia::Matrix3 about;
        centre << own[4], own[5], own[6];
        about << own[7], own[10], own[11], own[10], own[8], own[12], own[11], own[12], own[9];
        model.appendBodyToJoint(at, Inertia(own[3], centre, about));
    }
    const int n = model.nv;
    pin::DataTpl<SX> data(model);
    const SX q = SX::sym("q", n), v = SX::sym("v", n);
    Eigen::Matrix<SX, -1, 1> Q(n), V(n), none(n);
    for (int i = 0; i < n; i++) { Q[i] = q(i), V[i] = v(i), none[i] = SX(0); }
    const auto found = pin::aba(model, data, Q, V, none, pin::Convention::LOCAL);
    SX told(n, 1);
    for (int i = 0; i < n; i++) { told(i) = found[i]; }
    casadi::Function("aba", std::vector<SX>{q, v}, std::vector<SX>{told}).save(words[count - 1]);
    return 0;
}
