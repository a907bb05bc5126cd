// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/graph/pose_graph.h"

#include <ceres/ceres.h>

namespace ovimap {

namespace {

/// A pose as the solver changes it.
struct Node {
  Eigen::Vector3d place;
  Eigen::Quaterniond turn;
};

struct EdgeResidual {
  const PoseEdge& edge;

  template <class Scalar>
  bool operator()(const Scalar* from_place, const Scalar* from_turn, const Scalar* to_place,
                  const Scalar* to_turn, Scalar* residual) const {
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    const Eigen::Map<const Vector> from(from_place), to(to_place);
    const Eigen::Map<const Eigen::Quaternion<Scalar>> turned_from(from_turn), turned_to(to_turn);
    const Eigen::Quaternion<Scalar> back = turned_from.conjugate();
    const Eigen::Quaterniond measured(edge.from_to.linear());
    const Eigen::Quaternion<Scalar> off =
        measured.conjugate().template cast<Scalar>() * (back * turned_to);
    const Vector step = back * (to - from) - edge.from_to.translation().cast<Scalar>();
    const Scalar sign = off.w() < Scalar(0) ? Scalar(-2) : Scalar(2);
    Eigen::Map<Eigen::Matrix<Scalar, 6, 1>> result(residual);
    result.template head<3>() = step / Scalar(edge.sigma_m);
    result.template tail<3>() = sign * off.vec() / Scalar(edge.sigma_rad);
    return true;
  }
};

std::vector<Node> nodes_of(const std::vector<Pose>& poses) {
  std::vector<Node> nodes;
  for (const Pose& pose : poses)
    nodes.push_back({pose.translation(), Eigen::Quaterniond(pose.linear()).normalized()});
  return nodes;
}

std::vector<Pose> poses_of(const std::vector<Node>& nodes) {
  std::vector<Pose> poses;
  for (const Node& node : nodes) {
    poses.push_back(Pose::Identity());
    poses.back().linear() = node.turn.normalized().matrix();
    poses.back().translation() = node.place;
  }
  return poses;
}

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type =
      ceres::EIGEN_SPARSE;  // there in every build of Ceres
  options.max_num_iterations = 100;
  options.num_threads = 1;  // sums in one order
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

std::vector<Pose> optimise_poses(const std::vector<Pose>& poses,
                                 const std::vector<PoseEdge>& edges) {
  if (poses.empty() || edges.empty()) return poses;
  std::vector<Node> nodes = nodes_of(poses);
  ceres::Problem problem;
  for (Node& node : nodes) {
    problem.AddParameterBlock(node.place.data(), 3);
    problem.AddParameterBlock(node.turn.coeffs().data(), 4, new ceres::EigenQuaternionManifold);
  }
  for (const PoseEdge& edge : edges) {
    auto* cost =
        new ceres::AutoDiffCostFunction<EdgeResidual, 6, 3, 4, 3, 4>(new EdgeResidual{edge});
    ceres::LossFunction* loss = edge.loop ? new ceres::CauchyLoss(3.0) : nullptr;
    Node &from = nodes[edge.from], &to = nodes[edge.to];
    problem.AddResidualBlock(cost, loss, from.place.data(), from.turn.coeffs().data(),
                             to.place.data(), to.turn.coeffs().data());
  }
  problem.SetParameterBlockConstant(nodes.front().place.data());
  problem.SetParameterBlockConstant(nodes.front().turn.coeffs().data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  return summary.IsSolutionUsable() ? poses_of(nodes) : poses;
}

double edge_error(const std::vector<Pose>& poses, const PoseEdge& edge) {
  const Pose off = edge.from_to.inverse() * poses[edge.from].inverse() * poses[edge.to];
  const double metres = off.translation().norm() / edge.sigma_m,
               turned = Eigen::AngleAxisd(off.linear()).angle() / edge.sigma_rad;
  return std::sqrt(metres * metres + turned * turned);
}

}  // namespace ovimap
