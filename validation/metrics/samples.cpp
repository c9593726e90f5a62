#include "validation/metrics/samples.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace weir::validation {
namespace {

int face_axis_of(const FieldView& field, int component) { return field.where == Where::face ? component : -1; }

const FieldView& velocity(const FieldSet& fields) {
    const FieldView* u = fields.find("", "velocity");
    if (!u) throw BadInput("the solver shows no field \"velocity\"");
    return *u;
}

/// Index and weight of the lower of the two samples between which x stands along an axis.
struct Between {
    int lower = 0;
    real weight = 0;  // of the upper one
};
Between between(const GridView& g, int d, int face_axis, int count, real x) {
    const auto u = static_cast<std::size_t>(d);
    if (count == 1) return {};
    const real s = (x - g.origin[u]) / g.spacing[u] - (d == face_axis ? 0.0 : 0.5);
    const int lower = std::clamp(static_cast<int>(std::floor(s)), 0, count - 2);
    return {lower, std::clamp(s - lower, 0.0, 1.0)};
}

}  // namespace

real cell_volume(const GridView& g) {
    real v = 1;
    for (int d = 0; d < g.dim; ++d) v *= g.spacing[static_cast<std::size_t>(d)];
    return v;
}

Vec<3> middle(const GridView& g) {
    Vec<3> m{};
    for (int d = 0; d < g.dim; ++d) {
        const auto u = static_cast<std::size_t>(d);
        m[d] = g.origin[u] + g.spacing[u] * g.cells[u] / 2;
    }
    return m;
}

std::array<int, 3> sample_counts(const GridView& g, int face_axis) {
    std::array<int, 3> n = g.cells;
    if (face_axis >= 0) ++n[static_cast<std::size_t>(face_axis)];
    return n;
}

real value_at(const FieldView& field, const GridView& g, int component, const std::array<int, 3>& I) {
    const std::array<int, 3> n = sample_counts(g, face_axis_of(field, component));
    const std::size_t i = static_cast<std::size_t>(I[0]) +
                          static_cast<std::size_t>(n[0]) * (static_cast<std::size_t>(I[1]) + static_cast<std::size_t>(n[1] * I[2]));
    return field.data.at(static_cast<std::size_t>(component))[i];
}

Curve along_line(const FieldView& field, const GridView& g, int component, const Vec<3>& through, int axis) {
    const int face_axis = face_axis_of(field, component);
    const std::array<int, 3> n = sample_counts(g, face_axis);
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const auto B = static_cast<std::size_t>(b), C = static_cast<std::size_t>(c), A = static_cast<std::size_t>(axis);
    const Between at_b = between(g, b, face_axis, n[B], through[b]), at_c = between(g, c, face_axis, n[C], through[c]);
    Curve line{.label = field.name, .x = {}, .y = {}};
    for (int i = 0; i < n[A]; ++i) {
        real value = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const int up_b = corner & 1, up_c = corner >> 1;
            const real weight = (up_b ? at_b.weight : 1 - at_b.weight) * (up_c ? at_c.weight : 1 - at_c.weight);
            if (weight == 0) continue;
            std::array<int, 3> I{};
            I[A] = i, I[B] = at_b.lower + up_b, I[C] = at_c.lower + up_c;
            value += weight * value_at(field, g, component, I);
        }
        line.x.push_back(g.origin[A] + g.spacing[A] * (i + (axis == face_axis ? 0.0 : 0.5)));
        line.y.push_back(value);
    }
    return line;
}

real cubic(const Curve& c, real at) {
    if (c.size() < 4) throw BadInput("four points are needed for a cubic");
    const auto above = std::lower_bound(c.x.begin(), c.x.end(), at) - c.x.begin();
    const auto first = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 2, 0, static_cast<std::ptrdiff_t>(c.size()) - 4));
    real value = 0;
    for (std::size_t i = first; i < first + 4; ++i) {
        real l = c.y[i];
        for (std::size_t j = first; j < first + 4; ++j)
            if (j != i) l *= (at - c.x[j]) / (c.x[i] - c.x[j]);
        value += l;
    }
    return value;
}

real mean_kinetic_energy(const FieldSet& fields) {
    const FieldView& u = velocity(fields);
    real energy = 0;
    for (int c = 0; c < u.components(); ++c) {
        real sum = 0, weight = 0;
        const auto& data = u.data[static_cast<std::size_t>(c)];
        for_each_sample(fields.grid, face_axis_of(u, c), [&](const Vec<3>&, real w, std::size_t i) {
            sum += w * data[i] * data[i];
            weight += w;
        });
        energy += sum / weight / 2;
    }
    return energy;
}

real max_speed(const FieldSet& fields) {
    const FieldView& u = velocity(fields);
    const FieldView* phi = fields.find("", "level_set");
    const GridView& g = fields.grid;
    real speed = 0;
    for (int c = 0; c < u.components(); ++c) {
        const auto C = static_cast<std::size_t>(c);
        const std::array<int, 3> n = sample_counts(g, face_axis_of(u, c));
        const auto wet = [&](std::array<int, 3> I) {
            if (!phi || u.where != Where::face) return true;
            const bool above = I[C] < g.cells[C] && value_at(*phi, g, 0, I) < 0;
            --I[C];
            return above || (I[C] >= 0 && value_at(*phi, g, 0, I) < 0);
        };
        for (int k = 0; k < n[2]; ++k)
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i) {
                    const real v = std::abs(value_at(u, g, c, {i, j, k}));
                    if (!(v <= speed) && wet({i, j, k})) speed = v;
                }
    }
    return speed;
}

}  // namespace weir::validation
