#include "surfaces/particle_field.hpp"

#include "core/parallel.hpp"
#include "surfaces/reference.hpp"

#include <algorithm>
#include <cmath>

namespace weir::surfaces {

namespace {

/// Samples of a block along each axis: its sums fit in the first-level cache; the same number along z, and for a 2D liquid along y. Rows
/// have space for a vector on both sides, so that no particle's row must be clipped.
constexpr int block_x = 16, block_y = 8, block_z = 8;
constexpr int lanes = 8, row_length = lanes + block_x + lanes;
static_assert(block_y == block_z);
constexpr int rows_of_block = block_y * block_z;
/// A cell is full if it has at least this fraction of the particles of a liquid at rest.
constexpr float full_part = 0.5F;

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

int blocks_along(int samples, int length) { return (samples + length - 1) / length; }

}  // namespace

void ParticleField::lay(const particles::Box& box, std::int64_t count, real spacing, const Samples& samples) {
    grid_ = particles::cover_box(box, static_cast<int>(count), reach * spacing);
    origin_ = samples.first;
    step_ = static_cast<float>(samples.spacing[0] / spacing);
    cell_width_ = static_cast<float>(1 / (grid_.per_cell * spacing));
    for (std::size_t a = 0; a < 3; ++a) cell_origin_[a] = static_cast<float>((grid_.origin[a] - origin_[a]) / spacing);
}

PlaneRange ParticleField::cells_read(const Samples& samples, PlaneRange planes) const {
    if (planes.begin >= planes.end) return {0, 0};
    const int count = samples.n[slowest()], cells = grid_.cells[slowest()];
    const auto at = [&](int plane) { return step_ * static_cast<float>(plane); };
    // particles within reach, and those needed for their neighbour sums
    PlaneRange read = cells_between(slowest(), at(planes.begin) - outermost() - step_, at(planes.end) + outermost() + step_);
    const float radius = method_ == Method::anisotropic ? static_cast<float>(far_reach) : static_cast<float>(reach);
    const int measured = method_ == Method::zhu_bridson ? 0 : static_cast<int>(std::ceil(radius / cell_width_)) + 1;
    read.begin -= measured, read.end += measured;
    // all cells that decide whether a block is deep in the liquid
    const int first = planes.begin / block_z * block_z, last = std::min(count, (planes.end + block_z - 1) / block_z * block_z);
    const PlaneRange blocks = cells_between(slowest(), at(first), at(last - 1));
    return {std::max(0, std::min(read.begin, blocks.begin - 1)), std::min(cells, std::max(read.end, blocks.end + 1))};
}

int ParticleField::cell_plane(real x) const {
    const std::size_t a = slowest();
    return std::min(static_cast<int>((x - grid_.origin[a]) * grid_.per_cell), grid_.cells[a] - 1);
}

void ParticleField::compute(const Cloud& cloud, Samples& samples) {
    cloud_ = &cloud;
    blocks_.clear();
    if (samples.own.begin >= samples.own.end) return;
    const bool all = samples.own == PlaneRange{0, samples.n[slowest()]};
    read_ = all ? PlaneRange{0, grid_.cells[slowest()]} : cells_read(samples, samples.own);
    sort(cloud);
    find_deep_cells();
    find_blocks(samples);
    measure_particles();
#pragma omp parallel for schedule(dynamic, 4) num_threads(threads())
    for (int b = 0; b < static_cast<int>(blocks_.size()); ++b) fill(blocks_[static_cast<std::size_t>(b)], samples);
}

float ParticleField::outermost() const {
    return static_cast<float>(method_ == Method::anisotropic ? far_reach * longest + farthest_move : reach);
}

void ParticleField::sort(const Cloud& cloud) {
    const int plane = grid_.cells[0] * grid_.cells[1];
    if (flat_)  // its rows of cells span many layers
        cells_.sort(cloud.coordinates(), cloud.count(), grid_);
    else
        cells_.sort(cloud.coordinates(), cloud.count(), grid_, plane * read_.begin, plane * read_.end);
    const std::vector<int>& order = cells_.order();
    for (std::size_t a = 0; a < 3; ++a) {
        x_[a].resize(order.size());
        const real per_spacing = 1 / cloud.spacing;
        parallel_for(0, cloud.count(), [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            x_[a][at] = static_cast<float>((cloud.x[a][static_cast<std::size_t>(order[at])] - origin_[a]) * per_spacing);
        });
    }
}

/// A cell is deep where it and all its neighbours are full: its samples are inside.
void ParticleField::find_deep_cells() {
    const auto& n = grid_.cells;
    const auto& start = cells_.start();
    const float enough = full_part * cell_width_ * cell_width_ * cell_width_;
    const std::size_t count = start.size() - 1;
    full_.resize(count), deep_.assign(count, 0), needed_.assign(count, 0);
    for (std::size_t c = 0; c < count; ++c) full_[c] = static_cast<float>(start[c + 1] - start[c]) >= enough;
    const PlaneRange ks = flat_ ? PlaneRange{0, n[2]} : read_;
    parallel_for(ks.begin + 1, ks.end - 1, [&](int k) {
        for (int j = 1; j + 1 < n[1]; ++j)
            for (int i = 1; i + 1 < n[0]; ++i) {
                bool all = true;
                for (int dk = -1; dk <= 1; ++dk)
                    for (int dj = -1; dj <= 1; ++dj) {
                        const char* row = full_.data() + row_of(j + dj, k + dk) + i;
                        all = all && row[-1] && row[0] && row[1];
                    }
                deep_[row_of(j, k) + static_cast<std::size_t>(i)] = all;
            }
    });
}

std::array<float, 3> ParticleField::low(const Block& block) const {
    return {step_ * static_cast<float>(block.begin[0]), step_ * static_cast<float>(block.begin[1]),
            step_ * static_cast<float>(block.begin[2])};
}
std::array<float, 3> ParticleField::high(const Block& block) const {
    return {step_ * static_cast<float>(block.end[0] - 1), step_ * static_cast<float>(block.end[1] - 1),
            step_ * static_cast<float>(block.end[2] - 1)};
}

PlaneRange ParticleField::cells_between(std::size_t axis, float lo, float hi) const {
    // slightly more: cells were chosen in double precision, so a particle may lie beyond its cell by rounding
    constexpr float hair = 1e-3F;
    return {static_cast<int>(std::floor((lo - hair - cell_origin_[axis]) / cell_width_)),
            static_cast<int>(std::floor((hi + hair - cell_origin_[axis]) / cell_width_)) + 1};
}

ParticleField::CellBox ParticleField::cells_in(const std::array<float, 3>& lo, const std::array<float, 3>& hi) const {
    CellBox box{{}, {}, false};
    for (std::size_t a = 0; a < 3; ++a) {
        const PlaneRange cells = cells_between(a, lo[a], hi[a]);
        const PlaneRange all = a == slowest() ? read_ : PlaneRange{0, grid_.cells[a]};
        box.begin[a] = std::max(all.begin, cells.begin), box.end[a] = std::min(all.end, cells.end);
        box.beyond = box.beyond || cells.begin < 0 || cells.end > grid_.cells[a];
    }
    return box;
}

template <class F>
void ParticleField::for_runs(const CellBox& box, const F& f) const {
    if (box.begin[0] >= box.end[0]) return;
    for (int k = box.begin[2]; k < box.end[2]; ++k)
        for (int j = box.begin[1]; j < box.end[1]; ++j) {
            const std::size_t row = row_of(j, k);
            const int first = cells_.start()[row + static_cast<std::size_t>(box.begin[0])];
            const int behind = cells_.start()[row + static_cast<std::size_t>(box.end[0])];
            if (first < behind) f(first, behind);
        }
}

bool ParticleField::is_deep(const Block& whole) const {
    const CellBox box = cells_in(low(whole), high(whole));
    if (box.beyond) return false;
    for (int k = box.begin[2]; k < box.end[2]; ++k)
        for (int j = box.begin[1]; j < box.end[1]; ++j)
            for (int i = box.begin[0]; i < box.end[0]; ++i)
                if (!deep_[row_of(j, k) + static_cast<std::size_t>(i)]) return false;
    return true;
}

void ParticleField::find_blocks(const Samples& samples) {
    const std::array<int, 3> length{block_x, block_y, block_z};
    const float far = outermost();
    const float dry = method_ == Method::zhu_bridson ? -1.0F : std::max(-1.0F, profile_of(method_, flat_).depth(0.0F));
    const std::size_t cut = slowest();
    std::array<int, 3> first{0, 0, 0}, last = samples.n;
    first[cut] = samples.own.begin, last[cut] = samples.own.end;
    Block block{};
    for (int k = first[2] / block_z; k < blocks_along(last[2], block_z); ++k)
        for (int j = first[1] / block_y; j < blocks_along(last[1], block_y); ++j)
            for (int i = 0; i < blocks_along(samples.n[0], block_x); ++i) {
                const std::array<int, 3> number{i, j, k};
                for (std::size_t a = 0; a < 3; ++a) {
                    block.begin[a] = number[a] * length[a];
                    block.end[a] = std::min(samples.n[a], block.begin[a] + length[a]);
                }
                const bool inside = is_deep(block);  // in parallel for the whole block, too
                block.begin[cut] = std::max(block.begin[cut], first[cut]), block.end[cut] = std::min(block.end[cut], last[cut]);
                auto lo = low(block), hi = high(block);
                for (std::size_t a = 0; a < 3; ++a) lo[a] -= far, hi[a] += far;
                bool any = false;
                if (!inside) for_runs(cells_in(lo, hi), [&](int, int) { any = true; });
                block.computed = any;
                block.value = inside ? 1.0F : dry;
                blocks_.push_back(block);
                if (any) mark_needed(block);
            }
}

void ParticleField::mark_needed(const Block& block) {
    auto lo = low(block), hi = high(block);
    // one step more: a surface point may lie between the block's last sample and the next one
    for (std::size_t a = 0; a < 3; ++a) lo[a] -= outermost() + step_, hi[a] += outermost() + step_;
    const CellBox box = cells_in(lo, hi);
    for (int k = box.begin[2]; k < box.end[2]; ++k)
        for (int j = box.begin[1]; j < box.end[1]; ++j)
            for (int i = box.begin[0]; i < box.end[0]; ++i) needed_[row_of(j, k) + static_cast<std::size_t>(i)] = 1;
}

void ParticleField::measure_particles() {
    if (method_ == Method::zhu_bridson) return;
    if (method_ == Method::density) peak_.resize(x_[0].size()), crowding_.resize(x_[0].size());
    if (method_ == Method::anisotropic) blobs_.resize(x_[0].size());
    const auto& start = cells_.start();
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads())
    for (int c = 0; c < static_cast<int>(needed_.size()); ++c)
        if (needed_[static_cast<std::size_t>(c)])
            for (int i = start[static_cast<std::size_t>(c)]; i < start[static_cast<std::size_t>(c) + 1]; ++i) measure(i);
}

/// Density, and for anisotropic kernels the moments, of the neighbours of one particle; vectorized, lanes are added in order.
void ParticleField::measure(int i) {
    const auto at = static_cast<std::size_t>(i);
    const bool moments = method_ == Method::anisotropic;
    const float radius = moments ? static_cast<float>(far_reach) : static_cast<float>(reach);
    const std::array<float, 3> x{x_[0][at], x_[1][at], x_[2][at]};
    // lane sums: bump, crowding, weight, 3 first, 6 second moments, count
    constexpr int sums = 13;
    alignas(64) float sum[sums][lanes] = {};
    const float per_reach2 = 1 / static_cast<float>(reach * reach), per_far2 = 1 / static_cast<float>(far_reach * far_reach);
    const auto meet = [&](int l, float dx, float dy, float dz) {
        const float d2 = dx * dx + dy * dy + dz * dz;
        const float near = std::max(0.0F, 1 - d2 * per_reach2);
        sum[0][l] += near * near * near;
        sum[1][l] += near;
        if (!moments) return;
        const float q2 = d2 * per_far2, w = std::max(0.0F, 1 - q2 * std::sqrt(q2));
        sum[2][l] += w;
        sum[3][l] += w * dx, sum[4][l] += w * dy, sum[5][l] += w * dz;
        sum[6][l] += w * dx * dx, sum[7][l] += w * dy * dy, sum[8][l] += w * dz * dz;
        sum[9][l] += w * dx * dy, sum[10][l] += w * dx * dz, sum[11][l] += w * dy * dz;
        sum[12][l] += w > 0 ? 1.0F : 0.0F;
    };
    const CellBox box = cells_in({x[0] - radius, x[1] - radius, x[2] - radius}, {x[0] + radius, x[1] + radius, x[2] + radius});
    for_runs(box, [&](int first, int behind) {
        const float *px = x_[0].data(), *py = x_[1].data(), *pz = x_[2].data();
        int j = first;
        for (; j + lanes <= behind; j += lanes)
            for (int l = 0; l < lanes; ++l) meet(l, px[j + l] - x[0], py[j + l] - x[1], pz[j + l] - x[2]);
        for (; j < behind; ++j) meet(0, px[j] - x[0], py[j] - x[1], pz[j] - x[2]);
    });
    real total[sums];
    for (int s = 0; s < sums; ++s) {
        total[s] = 0;
        for (int l = 0; l < lanes; ++l) total[s] += static_cast<real>(sum[s][l]);
    }
    const real volume = std::max(1.0, lonely_density * reach * reach * reach / (bump_norm * total[0]));
    if (!moments) {
        peak_[at] = static_cast<float>(volume * bump_norm / (reach * reach * reach));
        crowding_[at] = static_cast<float>(total[1] - 1);  // without itself
        return;
    }
    const Moments m{total[2],
                    {total[3], total[4], total[5]},
                    {total[6], total[7], total[8], total[9], total[10], total[11]},
                    static_cast<int>(total[12])};
    const Blob blob = stretched({{real(x[0]), real(x[1]), real(x[2])}}, m, volume);
    FloatBlob& to = blobs_[at];
    for (std::size_t a = 0; a < 3; ++a) to.centre[a] = static_cast<float>(blob.centre[a]), to.half[a] = static_cast<float>(blob.half[a]);
    for (std::size_t a = 0; a < 6; ++a) to.stretch[a] = static_cast<float>(blob.stretch[a]);
    to.peak = static_cast<float>(blob.peak);
}

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

long ParticleField::computed() const {
    long count = 0;
    for (const Block& b : blocks_)
        if (b.computed) count += long(b.end[0] - b.begin[0]) * (b.end[1] - b.begin[1]) * (b.end[2] - b.begin[2]);
    return count;
}

std::size_t ParticleField::bytes() const {
    return cells_.bytes() + 3 * x_[0].capacity() * sizeof(float) + 3 * needed_.capacity() + blocks_.capacity() * sizeof(Block) +
           (peak_.capacity() + crowding_.capacity()) * sizeof(float) + blobs_.capacity() * sizeof(FloatBlob);
}

}  // namespace weir::surfaces
