// Schema of shapes and of prescribed motions. A sphere is a circle in 2D; a compound shape contains this same list recursively.
#include "scene/schema.hpp"

namespace weir::scene {
namespace {

Key point(std::string name, std::string doc) {
    return {.name = std::move(name), .type = Type::numbers, .doc = std::move(doc), .unit = "m", .required = true, .length = -1};
}

Key radius(std::string doc) {
    return {.name = "radius", .type = Type::number, .doc = std::move(doc), .unit = "m", .required = true, .min = 0, .min_open = true};
}

Key shape_list(std::string name, std::string doc) {
    return {.name = std::move(name),
            .type = Type::tables,
            .doc = std::move(doc),
            .required = true,
            .selector = "shape",
            .variants_from = &shapes};
}

std::vector<Key> keyframe_keys() {
    return {
        {.name = "t", .type = Type::number, .doc = "Time of the frame; frames stand in increasing order.", .unit = "s", .required = true},
        {.name = "offset",
         .type = Type::numbers,
         .doc = "Displacement from the position in the scene.",
         .unit = "m",
         .fallback = std::vector<double>{0},
         .length = -1},
        {.name = "angle",
         .type = Type::number,
         .doc = "Rotation about the motion's centre (and axis), anticlockwise.",
         .unit = "rad",
         .fallback = 0.0}};
}

Key turning_centre() {
    return {.name = "centre",
            .type = Type::numbers,
            .doc = "The point about which it turns; the middle of the shape where absent.",
            .unit = "m",
            .length = -1};
}

Key axis() {
    return {.name = "axis",
            .type = Type::numbers,
            .doc = "Axis of rotation; its length does not matter.",
            .fallback = std::vector<double>{0, 0, 1},
            .length = 3,
            .only_dim = 3};
}

}  // namespace

/// One list: its entries are data, not steps.
const std::vector<Variant>& shapes() {
    static const std::vector<Variant> list = {
        {"box",
         "All points between two corners.",
         {point("min", "Lower corner."), point("max", "Upper corner; greater than `min` along every axis.")}},
        {"sphere", "A ball; a disc in 2D.", {point("centre", "Centre."), radius("Radius.")}},
        {"plane",
         "The half space behind a plane (a line in 2D), on the side away from its normal.",
         {point("point", "A point of the plane."),
          {.name = "normal",
           .type = Type::numbers,
           .doc = "Outward normal of the shape; its length does not matter.",
           .required = true,
           .length = -1}}},
        {"wave",
         "All points below y = level + amplitude cos(2 pi x / wavelength).",
         {{.name = "level", .type = Type::number, .doc = "Mean height of the surface.", .unit = "m", .required = true},
          {.name = "amplitude", .type = Type::number, .doc = "Height of the crest at x = 0 above it.", .unit = "m", .required = true},
          {.name = "wavelength",
           .type = Type::number,
           .doc = "Distance between crests.",
           .unit = "m",
           .required = true,
           .min = 0,
           .min_open = true}}},
        {"capsule",
         "All points within `radius` of a segment.",
         {point("from", "One end of the segment."), point("to", "Its other end."), radius("Radius.")}},
        {"cylinder",
         "A cylinder with flat ends; a rectangle in 2D.",
         {point("from", "Centre of one end."), point("to", "Centre of the other end."), radius("Radius; half the width in 2D.")}},
        {"mesh",
         "The region inside a closed surface of triangles; 3D only.",
         {{.name = "file",
           .type = Type::text,
           .doc = "An OBJ, PLY or STL file, its path from the scene's folder. Closed and manifold; turned where it is inside out.",
           .required = true,
           .example = "file = \"duck.obj\""},
          {.name = "scale",
           .type = Type::number,
           .doc = "Length of one unit of the file; 0.001 where it is in millimetres.",
           .unit = "m",
           .fallback = 1.0,
           .min = 0,
           .min_open = true},
          {.name = "at",
           .type = Type::numbers,
           .doc = "Position of the file's origin.",
           .unit = "m",
           .fallback = std::vector<double>{0, 0, 0},
           .length = 3},
          axis(),
          {.name = "angle",
           .type = Type::number,
           .doc = "Rotation about the axis through the file's origin, anticlockwise.",
           .unit = "rad",
           .fallback = 0.0},
          {.name = "resolution",
           .type = Type::integer,
           .doc = "Cells along the longest side of the grid on which its distance is sampled when it is read.",
           .fallback = std::int64_t{96},
           .min = 8,
           .max = 400}}},
        {"union", "Inside any of several shapes.", {shape_list("of", "The shapes.")}},
        {"difference",
         "Inside one shape, outside all others.",
         {{.name = "from",
           .type = Type::table,
           .doc = "The shape from which others are subtracted.",
           .required = true,
           .selector = "shape",
           .variants_from = &shapes},
          shape_list("minus", "The shapes that are subtracted.")}},
    };
    return list;
}

const std::vector<Variant>& motions() {
    static const std::vector<Variant> list = {
        {"constant",
         "x(t) = x(0) + velocity t",
         {{.name = "velocity", .type = Type::numbers, .doc = "Velocity.", .unit = "m/s", .required = true, .length = -1}}},
        {"sinusoidal",
         "x(t) = x(0) + amplitude (sin(2 pi frequency t + phase) - sin(phase)): it starts at the position in the scene.",
         {{.name = "amplitude",
           .type = Type::numbers,
           .doc = "Greatest displacement along each axis.",
           .unit = "m",
           .required = true,
           .length = -1},
          {.name = "frequency", .type = Type::number, .doc = "Frequency.", .unit = "1/s", .required = true, .min = 0, .min_open = true},
          {.name = "phase", .type = Type::number, .doc = "Phase at t = 0.", .unit = "rad", .fallback = 0.0}}},
        {"rotation",
         "Rotation about a point (2D) or an axis through it (3D), anticlockwise seen against the axis.",
         {turning_centre(), axis(), {.name = "rate", .type = Type::number, .doc = "Angular velocity.", .unit = "rad/s", .required = true}}},
        {"keyframes",
         "Linear between frames, at rest before the first and after the last.",
         {{.name = "frames", .type = Type::tables, .doc = "At least one frame.", .required = true, .keys = keyframe_keys()},
          turning_centre(),
          axis()}},
    };
    return list;
}

}  // namespace weir::scene
