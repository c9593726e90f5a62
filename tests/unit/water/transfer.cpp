#include "water/transfer.hpp"
#include "support.hpp"

namespace transfer_tests {

using namespace weir;
using namespace weir::water;

namespace {

/// 2^D jittered markers in each of the middle cells of a unit box of 12^D cells, moving with a given velocity.
template <int D>
struct Cloud {
    MacVelocity<D> u{replicated(Index<D>::constant(12)), Vec<D>::constant(1.0 / 12), Vec<D>{}};
    Frame<D> frame{u, geometry::Sides<D>()};
    FaceSums<D> sums{u.cells};
    std::array<Grid<std::uint8_t, D>, D> known;
    Markers<D> markers;

    template <class V>
    Cloud(bool affine, V velocity) : markers(true, affine) {
        for (int a = 0; a < D; ++a) known[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(u[a].extent());
        set_threads(1);
        for_each_in(Index<D>::constant(3), replicated(Index<D>::constant(9)), [&](const Index<D>& I) {
            for (int sub = 0; sub < Markers<D>::per_cell; ++sub) {
                const Vec<D> x = Markers<D>::jittered(frame, I, sub, 11);
                markers.add(x, velocity(x));
            }
        });
        markers.sort(frame);
    }
    void to_faces() { markers_to_faces(markers, frame, sums, u, known); }
    /// Σ over faces of weight × (x × u)_z and of weight × u.
    real angular_momentum() const {
        real sum = 0;
        for (int a = 0; a < 2; ++a) {
            const auto& s = sums.sum[static_cast<std::size_t>(a)];
            sum += sum_over(s.extent(), [&](const Index<D>& I) {
                const Vec<D> x = u.face_centre(a, I);
                return s(I).momentum * (a == 1 ? x[0] : -x[1]);
            });
        }
        return sum;
    }
    Vec<D> momentum() const {
        Vec<D> total;
        for (int a = 0; a < D; ++a) {
            const auto& s = sums.sum[static_cast<std::size_t>(a)];
            total[a] = sum_over(s.extent(), [&](const Index<D>& I) { return s(I).momentum; });
        }
        return total;
    }
};

template <int D>
Vec<D> rotation(const Vec<D>& x) {
    Vec<D> v{};
    v[0] = -(x[1] - 0.5), v[1] = x[0] - 0.5;
    return v;
}

}  // namespace

TEST_IN_2D_AND_3D("markers give their momentum to the faces without loss") {
    Cloud<D> cloud(false, [](const Vec<D>& x) { return 3.0 * x - Vec<D>::constant(1); });
    cloud.to_faces();
    Vec<D> carried{};
    for (std::size_t p = 0; p < cloud.markers.count(); ++p)
        for (int a = 0; a < D; ++a) carried[a] += cloud.markers.v[static_cast<std::size_t>(a)][p];
    for (int a = 0; a < D; ++a) EXPECT_NEAR(cloud.momentum()[a], carried[a], 1e-12 * static_cast<real>(cloud.markers.count()));
}

TEST_IN_2D_AND_3D("a uniform velocity survives every transfer exactly, also beside walls") {
    for (const bool affine : {false, true}) {
        Cloud<D> cloud(affine, [](const Vec<D>&) { return Vec<D>::constant(0.7); });
        cloud.to_faces();
        for (int a = 0; a < D; ++a) cloud.u[a].fill(0.7);
        auto before = cloud.u;
        if (affine)
            apic_to_markers(cloud.u, cloud.frame, cloud.markers);
        else
            flip_to_markers(cloud.u, before, 0.97, cloud.frame, cloud.markers);
        for (std::size_t p = 0; p < cloud.markers.count(); ++p) EXPECT_NEAR(cloud.markers.v[0][p], 0.7, 1e-14);
    }
}

// Markers on both sides of it give to its faces, which stand at either end of memory. Some hundred terms are added and divided.
TEST_IN_2D_AND_3D("a uniform velocity survives at the seam of periodic axes") {
    set_threads(1);
    MacVelocity<D> u{replicated(Index<D>::constant(6)), Vec<D>::constant(1.0 / 6), Vec<D>{}};
    geometry::Sides<D> sides;
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) sides.side(a, end).kind = geometry::SideKind::periodic;
    const Frame<D> frame(u, sides);
    FaceSums<D> sums(u.cells);
    std::array<Grid<std::uint8_t, D>, D> known;
    for (int a = 0; a < D; ++a) known[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(u[a].extent());
    for (const bool affine : {false, true}) {
        Markers<D> markers(true, affine);
        for_each_cell(u.cells, [&](const Index<D>& I) {
            for (int sub = 0; sub < Markers<D>::per_cell; ++sub)
                markers.add(Markers<D>::jittered(frame, I, sub, 11), Vec<D>::constant(0.7));
        });
        markers.sort(frame);
        markers_to_faces(markers, frame, sums, u, known);
        for (int a = 0; a < D; ++a)
            for_each_cell(u[a].extent(), [&](const Index<D>& I) { EXPECT_NEAR(u[a](I), 0.7, 1e-13) << a << ' ' << I[a]; });
    }
}

TEST_IN_2D_AND_3D("APIC keeps the angular momentum of a spinning body through markers, faces and markers; PIC loses it") {
    // Jiang et al. 2015, section 5: to the faces and back is exact; the grid's own angular momentum is the measure.
    const auto lost_in_a_round_trip = [](bool affine) {
        Cloud<D> cloud(affine, rotation<D>);
        if (affine)
            for (std::size_t p = 0; p < cloud.markers.count(); ++p) cloud.markers.c[1][p] = -1, cloud.markers.c[D][p] = 1;
        cloud.to_faces();
        const real before = cloud.angular_momentum();
        if (affine)
            apic_to_markers(cloud.u, cloud.frame, cloud.markers);
        else
            pic_to_markers(cloud.u, cloud.frame, cloud.markers);
        cloud.to_faces();
        return std::abs(cloud.angular_momentum() / before - 1);
    };
    EXPECT_LT(lost_in_a_round_trip(true), 1e-12);
    EXPECT_GT(lost_in_a_round_trip(false), 1e-2);
}

TEST_IN_2D_AND_3D("APIC reproduces a linear velocity field exactly where markers surround a face") {
    Cloud<D> cloud(true, rotation<D>);
    for (std::size_t p = 0; p < cloud.markers.count(); ++p) cloud.markers.c[1][p] = -1, cloud.markers.c[D][p] = 1;
    cloud.to_faces();
    for (int a = 0; a < D; ++a)
        for_each_in(Index<D>::constant(4), replicated(Index<D>::constant(8)),
                    [&](const Index<D>& I) { EXPECT_NEAR(cloud.u[a](I), rotation<D>(cloud.u.face_centre(a, I))[a], 1e-13); });
}

TEST_IN_2D_AND_3D("FLIP with blend 1 adds only what the grid changed: an unchanged grid changes no marker") {
    Cloud<D> cloud(false, [](const Vec<D>& x) { return Vec<D>::constant(std::sin(40 * x[0] * x[1])); });
    cloud.to_faces();
    for (int a = 0; a < D; ++a)
        for_each_cell(cloud.u[a].extent(), [&](const Index<D>& I) {
            if (!cloud.known[static_cast<std::size_t>(a)](I)) cloud.u[a](I) = 0;
        });
    const auto carried = cloud.markers.v;
    auto before = cloud.u;
    flip_to_markers(cloud.u, before, 1, cloud.frame, cloud.markers);
    EXPECT_EQ(cloud.markers.v, carried);
}

TEST_IN_2D_AND_3D("what markers give to faces does not depend on the number of threads") {
    Cloud<D> cloud(true, [](const Vec<D>& x) { return Vec<D>::constant(std::sin(40 * x[0] * x[1])); });
    cloud.to_faces();
    const auto serial = cloud.u;
    for (const int count : {2, 3}) {
        set_threads(count);
        cloud.to_faces();
        for (int a = 0; a < D; ++a)
            EXPECT_TRUE(std::equal(serial[a].values().begin(), serial[a].values().end(), cloud.u[a].values().begin()));
    }
    set_threads(1);
}

}  // namespace transfer_tests
