#include "surfaces/kernel.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace weir::surfaces {

Blob stretched(const Vec<3>& x, const Moments& m, real volume) {
    Blob blob;
    const Vec<3> mean{{m.first[0] / m.weight, m.first[1] / m.weight, m.first[2] / m.weight}};
    const real away = norm(mean), move = std::min(farthest_move, nearness * std::max(0.0, away - mean_of_plane));
    blob.centre = move > 0 ? x + (move / away) * mean : x;
    const bool many = m.count > few_neighbours;
    Eigen::Vector3d axes = Eigen::Vector3d::Constant(drop_size);
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
    if (many) {
        Eigen::Matrix3d c;
        const auto at = [&](std::size_t s, int a, int b) { return inside_scale * (m.second[s] / m.weight - mean[a] * mean[b]); };
        c << at(0, 0, 0), at(3, 0, 1), at(4, 0, 2), at(3, 0, 1), at(1, 1, 1), at(5, 1, 2), at(4, 0, 2), at(5, 1, 2), at(2, 2, 2);
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved;
        solved.compute(c);
        turned = solved.eigenvectors();
        const real most = solved.eigenvalues()[2];
        for (int a = 0; a < 3; ++a) axes[a] = std::min(longest, std::max(solved.eigenvalues()[a], flattest * most));
    }
    const Eigen::Matrix3d inverse = turned * (axes * far_reach).asDiagonal() * turned.transpose();
    const Eigen::Matrix3d g = turned * (axes * far_reach).cwiseInverse().asDiagonal() * turned.transpose();
    blob.stretch = {g(0, 0), g(1, 1), g(2, 2), g(0, 1), g(0, 2), g(1, 2)};
    for (int a = 0; a < 3; ++a) blob.half[a] = inverse.row(a).norm();
    blob.peak = (many ? 1 : volume) * bump_norm / (far_reach * far_reach * far_reach * axes[0] * axes[1] * axes[2]);
    return blob;
}

}  // namespace weir::surfaces
