// 3D pictures: one ray a pixel through smoke or water, the edges of the domain drawn over it.
#include "app/picture/media.hpp"
#include "app/picture/sea.hpp"
#include "core/parallel.hpp"

namespace weir::picture {

namespace {

void draw_line(Canvas& canvas, const Vec<2>& a, const Vec<2>& b, const Colour& colour, real opacity) {
    const int steps = static_cast<int>(2 * norm(b - a)) + 1;
    for (int i = 0; i <= steps; ++i) {
        const Vec<2> p = a + (static_cast<real>(i) / steps) * (b - a);
        const int x = static_cast<int>(p[0]), y = static_cast<int>(p[1]);
        if (x >= 0 && y >= 0 && x < canvas.width() && y < canvas.height()) canvas.at(x, y) = mix(canvas.at(x, y), colour, opacity);
    }
}

/// The twelve edges, faint.
void draw_edges(Canvas& canvas, const Camera& camera, const Box& box, const Colour& colour) {
    const auto corner = [&](int bits) {
        return camera.pixel({{bits & 1 ? box.max[0] : box.min[0], bits & 2 ? box.max[1] : box.min[1], bits & 4 ? box.max[2] : box.min[2]}});
    };
    for (int from = 0; from < 8; ++from)
        for (const int bit : {1, 2, 4})
            if (!(from & bit)) draw_line(canvas, corner(from), corner(from | bit), colour, 0.35);
}

template <class Medium>
Canvas draw(const View& view) {
    const Medium medium(view);
    const Camera camera(medium.box(), view.size * oversampling);
    const Stage stage(view, medium.box());
    Canvas canvas(camera.width, camera.height);
    parallel_for(0, camera.height, [&](int y) {
        for (int x = 0; x < camera.width; ++x) canvas.at(x, y) = medium.look(camera.ray(x + 0.5, y + 0.5), stage);
    });
    draw_edges(canvas, camera, medium.box(), view.field == "water" ? hex(0x50565e) : hex(0x8d97a6));
    return canvas.smaller(oversampling);
}

}  // namespace

Canvas draw_3d(const View& view) {
    if (view.field != "water") return draw<Smoke>(view);
    return view.frame.particles.count("markers") == 0 && has_sea(view.frame) ? draw_sea(view) : draw<Water>(view);
}

}  // namespace weir::picture
