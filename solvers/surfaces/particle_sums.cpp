// Sums over the particles in reach of samples and of points: kernels, weighted offsets (Zhu & Bridson 2005, eq. 3) and weighted means.
#include "surfaces/particle_field.hpp"
#include "surfaces/reference.hpp"

#include <algorithm>
#include <cmath>

namespace weir::surfaces {

namespace {

/// As ParticleField::Block::length. Rows have space for a vector on both sides, so that no particle's row must be clipped.
constexpr int block_x = 16, block_y = 8, block_z = 8;
constexpr int lanes = 8, row_length = lanes + block_x + lanes;
constexpr int rows_of_block = block_y * block_z;

/// Sums at the samples of one block.
template <int Sums>
struct BlockSums {
    alignas(64) float sum[Sums][rows_of_block][row_length];
    BlockSums() {
        for (auto& one : sum)
            for (auto& row : one) std::fill(std::begin(row), std::end(row), 0.0F);
    }
};

/// First and last sample within `half` of x along an axis, relative to the block's first.
struct Span {
    int begin, end;
    bool empty() const { return begin >= end; }
};
Span span_of(float x, float half, float per_step, int first, int count) {
    return {std::max(0, static_cast<int>(std::ceil((x - half) * per_step)) - first),
            std::min(count, static_cast<int>(std::floor((x + half) * per_step)) + 1 - first)};
}

}  // namespace

/// Sums of weights and of weighted offsets (Zhu & Bridson 2005, eq. 3) to all samples in reach of each particle.
template <class Rows>
void ParticleField::scatter_means(const Block& block, Rows& rows) const {
    const float half = static_cast<float>(reach), per_step = 1 / step_, k = 1 / (half * half);
    auto lo = low(block), hi = high(block);
    for (std::size_t a = 0; a < 3; ++a) lo[a] -= half, hi[a] += half;
    for_runs(cells_in(lo, hi), [&](int first, int behind) {
        for (int p = first; p < behind; ++p) {
            const auto at = static_cast<std::size_t>(p);
            const float x = x_[0][at], y = x_[1][at], z = x_[2][at];
            if (x < lo[0] || x > hi[0]) continue;
            const Span ys = span_of(y, half, per_step, block.begin[1], block_y),
                       zs = span_of(z, half, per_step, block.begin[2], block.end[2] - block.begin[2]);
            const int i0 = std::max(-lanes, static_cast<int>(std::ceil((x - half) * per_step)) - block.begin[0]);
            const int i1 = std::min(block_x, static_cast<int>(std::floor((x + half) * per_step)) + 1 - block.begin[0]);
            for (int kz = zs.begin; kz < zs.end; ++kz)
                for (int ky = ys.begin; ky < ys.end; ++ky) {
                    const float dy = y - step_ * static_cast<float>(block.begin[1] + ky),
                                dz = z - step_ * static_cast<float>(block.begin[2] + kz);
                    const float across = 1 - (dy * dy + dz * dz) * k;
                    if (across <= 0) continue;
                    const int row = kz * block_y + ky;
                    for (int i = i0; i < i1; i += lanes) {
                        float* w0 = rows.sum[0][row] + lanes + i;
                        float* w1 = rows.sum[1][row] + lanes + i;
                        float* w2 = rows.sum[2][row] + lanes + i;
                        float* w3 = rows.sum[3][row] + lanes + i;
                        const float from = x - step_ * static_cast<float>(block.begin[0] + i);
                        for (int l = 0; l < lanes; ++l) {
                            const float dx = from - step_ * static_cast<float>(l);
                            const float t = std::max(0.0F, across - dx * dx * k), w = t * t * t;
                            w0[l] += w, w1[l] += w * dx, w2[l] += w * dy, w3[l] += w * dz;
                        }
                    }
                }
        }
    });
}

/// Sums of kernels, round or stretched, to all samples in reach of each particle.
template <class Rows>
void ParticleField::scatter_kernels(const Block& block, Rows& rows) const {
    const float per_step = 1 / step_, round = static_cast<float>(1 / reach);
    const bool stretched = method_ == Method::anisotropic;
    auto lo = low(block), hi = high(block);
    for (std::size_t a = 0; a < 3; ++a) lo[a] -= outermost(), hi[a] += outermost();
    for_runs(cells_in(lo, hi), [&](int first, int behind) {
        for (int p = first; p < behind; ++p) {
            const auto at = static_cast<std::size_t>(p);
            const float half = static_cast<float>(reach);
            const FloatBlob blob =
                stretched ? blobs_[at]
                          : FloatBlob{{x_[0][at], x_[1][at], x_[2][at]}, {half, half, half}, {round, round, round, 0, 0, 0}, peak_[at]};
            const auto& [x, y, z] = blob.centre;
            const auto& g = blob.stretch;
            const Span ys = span_of(y, blob.half[1], per_step, block.begin[1], block_y),
                       zs = span_of(z, blob.half[2], per_step, block.begin[2], block.end[2] - block.begin[2]);
            const int i0 = std::max(-lanes, static_cast<int>(std::ceil((x - blob.half[0]) * per_step)) - block.begin[0]);
            const int i1 = std::min(block_x, static_cast<int>(std::floor((x + blob.half[0]) * per_step)) + 1 - block.begin[0]);
            if (i0 >= i1) continue;
            for (int kz = zs.begin; kz < zs.end; ++kz)
                for (int ky = ys.begin; ky < ys.end; ++ky) {
                    const float dy = y - step_ * static_cast<float>(block.begin[1] + ky),
                                dz = z - step_ * static_cast<float>(block.begin[2] + kz);
                    const float a0 = g[3] * dy + g[4] * dz, a1 = g[1] * dy + g[5] * dz, a2 = g[5] * dy + g[2] * dz;
                    for (int i = i0; i < i1; i += lanes) {
                        float* to = rows.sum[0][kz * block_y + ky] + lanes + i;
                        const float from = x - step_ * static_cast<float>(block.begin[0] + i);
                        for (int l = 0; l < lanes; ++l) {
                            const float dx = from - step_ * static_cast<float>(l);
                            const float s0 = g[0] * dx + a0, s1 = g[3] * dx + a1, s2 = g[4] * dx + a2;
                            const float t = std::max(0.0F, 1 - (s0 * s0 + s1 * s1 + s2 * s2));
                            to[l] += blob.peak * (t * t * t);
                        }
                    }
                }
        }
    });
}

void ParticleField::fill(const Block& block, Samples& samples) const {
    static_assert(Block::length == std::array{block_x, block_y, block_z});
    const auto put = [&](const auto& depth) {
        for (int k = block.begin[2]; k < block.end[2]; ++k)
            for (int j = block.begin[1]; j < block.end[1]; ++j) {
                float* to = samples.depth.data() + samples.linear(block.begin[0], j, k);
                const int row = (k - block.begin[2]) * block_y + j - block.begin[1];
                for (int i = 0; i < block.end[0] - block.begin[0]; ++i) to[i] = std::clamp(depth(row, lanes + i), -1.0F, 1.0F);
            }
    };
    if (!block.computed) return put([&](int, int) { return block.value; });
    const Profile& profile = profile_of(method_, flat_);
    if (method_ == Method::zhu_bridson) {
        static thread_local BlockSums<4> scratch;
        scratch = BlockSums<4>();
        scatter_means(block, scratch);
        const auto& s = scratch.sum;
        return put([&](int row, int i) {
            const float w = s[0][row][i];
            if (w <= 0) return -1.0F;
            const float off = std::sqrt(s[1][row][i] * s[1][row][i] + s[2][row][i] * s[2][row][i] + s[3][row][i] * s[3][row][i]) / w;
            return profile.depth(off);
        });
    }
    static thread_local BlockSums<1> scratch;
    scratch = BlockSums<1>();
    scatter_kernels(block, scratch);
    put([&](int row, int i) { return profile.depth(scratch.sum[0][row][i]); });
}

/// value(sorted particle, weight) of each particle in reach of x.
template <class Value>
void ParticleField::weigh(const Vec<3>& x, const Value& value) const {
    std::array<float, 3> at, lo, hi;
    const float half = static_cast<float>(reach), k = 1 / (half * half);
    for (std::size_t a = 0; a < 3; ++a) {
        at[a] = static_cast<float>((x[a] - origin_[a]) / cloud_->spacing);
        lo[a] = at[a] - half, hi[a] = at[a] + half;
    }
    for_runs(cells_in(lo, hi), [&](int first, int behind) {
        for (int i = first; i < behind; ++i) {
            const auto p = static_cast<std::size_t>(i);
            const float dx = x_[0][p] - at[0], dy = x_[1][p] - at[1], dz = x_[2][p] - at[2];
            const float t = 1 - (dx * dx + dy * dy + dz * dz) * k;
            if (t > 0) value(p, real(t * t * t));
        }
    });
}

Vec<3> ParticleField::velocity_at(const Vec<3>& x, const std::array<std::span<const real>, 3>& velocity) const {
    Vec<3> sum{};
    real weight = 0;
    weigh(x, [&](std::size_t p, real w) {
        const auto from = static_cast<std::size_t>(cloud_->particle(cells_.order()[p]));
        weight += w;
        for (std::size_t a = 0; a < 3; ++a) sum[a] += w * velocity[a][from];
    });
    return weight > 0 ? sum / weight : Vec<3>{};
}

real ParticleField::crowding_at(const Vec<3>& x) const {
    real sum = 0, weight = 0;
    weigh(x, [&](std::size_t p, real w) { sum += w * real(crowding_[p]), weight += w; });
    return weight > 0 ? sum / weight : 0;
}

}  // namespace weir::surfaces
