// The extrapolation finds its fronts by rows and its neighbours by their place in memory; here it is held against the same visits written
// plainly, face by face.
#include "free_surface/extrapolate.hpp"
#include "support.hpp"

namespace extrapolate_tests {

using namespace weir;
using namespace weir::water;

namespace {

constexpr real steepest = 3;

template <int D>
struct Plain {
    const Frame<D>& frame;
    const LevelSet<D>& surface;
    int a;

    /// Moves I to the next face among those along a.
    bool step(Index<D>& I, int axis, int by) const {
        const int n = frame.cells[axis], i = I[axis] + by;
        if (frame.periodic(axis)) return I[axis] = (i % n + n) % n, true;
        if (i < 0 || i >= n + (axis == a ? 1 : 0)) return false;
        return I[axis] = i, true;
    }
    real phi(const Index<D>& face) const { return surface.phi(frame.near(face, a, -1)) + surface.phi(frame.near(face, a, 0)); }
    bool is_near(const Index<D>& face) const {
        for (const int side : {-1, 0}) {
            Index<D> I = face;
            I[a] += side;
            if (frame.periodic(a)) I[a] = (I[a] + frame.cells[a]) % frame.cells[a];
            if (surface.phi.contains(I) && surface.layer()(I) >= 1 && surface.layer()(I) <= std::min(3, surface.layers())) return true;
        }
        return false;
    }
    real slope(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, Index<D> J, int axis, int by, int layer) const {
        const auto finished = [&] { return step(J, axis, by) && mark(J) != 0 && mark(J) <= layer; };
        const real here = u(J);
        if (layer > 2 || !finished()) return 0;
        const real behind = u(J);
        if (!finished()) return 0;
        const real last = here - behind, before = behind - u(J), speed = std::abs(here);
        const real most = std::min(0.3 * speed, steepest * frame.h[axis] / std::max(speed, 1e-300));
        return last * before <= 0 ? 0 : std::clamp(std::abs(last) < std::abs(before) ? last : before, -most, most);
    }
    real value(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, const Index<D>& I, int layer) const {
        real weights = 0, sum = 0, plain = 0;
        int count = 0;
        for (int axis = 0; axis < D; ++axis) {
            std::array<real, 3> of_axis{};
            for (const int by : {-1, 1}) {
                Index<D> J = I;
                if (!step(J, axis, by) || mark(J) == 0 || mark(J) > layer) continue;
                const real w = std::max(0.0, phi(I) - phi(J)) * frame.inv_h[axis] * frame.inv_h[axis];
                of_axis[0] += w, of_axis[1] += w * (u(J) + slope(u, mark, J, axis, by, layer)), of_axis[2] += u(J);
                ++count;
            }
            weights += of_axis[0], sum += of_axis[1], plain += of_axis[2];
        }
        return weights * frame.h_min() > 1e-9 ? sum / weights : plain / count;
    }
    /// Faces of the first layer look for known ones; those of the next are beside one of the layer before.
    std::vector<Index<D>> front(const Grid<std::uint8_t, D>& mark, int layer) const {
        Grid<std::uint8_t, D> joins(mark.extent());
        for (std::size_t i = 0; i < mark.size(); ++i) {
            const Index<D> I = index_of<D>(mark.extent(), i);
            for (int axis = 0; axis < D; ++axis)
                for (const int by : {-1, 1}) {
                    Index<D> J = I;
                    if (!step(J, axis, by)) continue;
                    if (layer == 1 && mark(I) == 0 && mark(J) == 1 && is_near(I)) joins(I) = 1;
                    if (layer > 1 && mark(I) == layer && mark(J) == 0) joins(J) = 1;
                }
        }
        std::vector<Index<D>> list;
        for (std::size_t i = 0; i < joins.size(); ++i)
            if (joins[i]) list.push_back(index_of<D>(mark.extent(), i));
        return list;
    }
    void run(Grid<real, D>& u, Grid<std::uint8_t, D>& mark, int layers) const {
        for (int layer = 1; layer <= layers; ++layer) {
            const auto faces = front(mark, layer);
            std::vector<real> values;
            for (const Index<D>& I : faces) values.push_back(value(u, mark, I, layer));
            for (std::size_t i = 0; i < faces.size(); ++i) u(faces[i]) = values[i], mark(faces[i]) = static_cast<std::uint8_t>(layer + 1);
        }
    }
};

}  // namespace

TEST_IN_2D_AND_3D(
    "velocity beyond the liquid is what plain visits of every face give, to the last bit, beside walls and around periodic axes") {
    const std::pair<std::string, real> cases[] = {// and where the liquid stands: away from the sides, or across their seams
                                                  {"[]", 0.3},
                                                  {"[\"x\", \"y\"]", 0.3},
                                                  {D == 2 ? "[\"x\", \"y\"]" : "[\"x\", \"y\", \"z\"]", 0.0}};
    for (const auto& one : cases) {
        const real middle = one.second;
        const auto scene = test::water_scene(fmt::format(
            "solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {}, periodic = {} }}\ntime = {{ end = 1.0 }}\n"
            "liquid = [ {{ shape = \"sphere\", centre = {}, radius = 0.3 }} ]\n",
            D, test::list({"19", "16", "14"}, D), test::list({"1.4", "1.1", "0.9"}, D), one.first, test::list({"0.2", "0.3", "0.4"}, D)));
        const MacState<D> state(scene, FieldPlan{});
        const Frame<D> frame(state.u, state.sides);
        LevelSet<D> surface(frame, 1);
        for_each_cell(frame.cells, [&](const Index<D>& I) {
            Vec<D> x = frame.centre(I) - Vec<D>::constant(middle);
            for (int d = 0; d < D; ++d)
                if (frame.periodic(d)) x[d] -= frame.cells[d] * frame.h[d] * std::rint(x[d] / (frame.cells[d] * frame.h[d]));
            surface.phi(I) = norm(x) - 0.25 + 0.05 * std::sin(9 * x[0] + 5 * x[1]);
        });
        surface.redistance();
        auto u = state.u;
        FaceMarks<D> known;
        for (int a = 0; a < D; ++a) {
            auto& mark = known[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(u[a].extent());
            for_each_cell(u[a].extent(), [&](const Index<D>& I) {
                u[a](I) = std::sin(1.0 + a + 0.4 * I[0]) * std::cos(0.3 * I[1] + 0.2 * I[D - 1]);
                mark(I) = surface.phi(frame.near(I, a, -1)) < 0 || surface.phi(frame.near(I, a, 0)) < 0;
            });
        }
        sync_periodic(u, state.sides);
        auto plain = u;
        auto plain_known = known;
        const int layers = surface.layers() - 1;
        Extrapolation<D>(frame, steepest)(u, known, surface, FaceLists<D>{}, layers);
        std::size_t filled = 0;
        for (int a = 0; a < D; ++a) {
            const auto at = static_cast<std::size_t>(a);
            Plain<D>{frame, surface, a}.run(plain[a], plain_known[at], layers);
            for_each_cell(u[a].extent(), [&](const Index<D>& I) {
                EXPECT_EQ(known[at](I), plain_known[at](I));
                EXPECT_EQ(u[a](I), plain[a](I));
                EXPECT_TRUE(std::isfinite(u[a](I)));
                filled += known[at](I) > 1;
            });
        }
        EXPECT_GT(filled, 50u);
    }
}

}  // namespace extrapolate_tests
