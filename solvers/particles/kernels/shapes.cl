/* Signed distances of shapes, operation by operation as geometry/shape.cpp has them. Of a plane scene the third coordinate is zero. A scene's
   shapes are expressions over these functions (Shape::code). No contraction, as in all that decides a particle's place. */
#pragma OPENCL FP_CONTRACT OFF

WEIR_FN double dot_of(double4 a, double4 b) {
#if WEIR_DIM == 3
    return a.x * b.x + a.y * b.y + a.z * b.z;
#else
    return a.x * b.x + a.y * b.y;
#endif
}
WEIR_FN double norm_of(double4 a) { return sqrt(dot_of(a, a)); }

WEIR_FN double shape_box(double4 x, double4 low, double4 high) {
    const double4 q = fmax(low - x, x - high), out = fmax(q, (double4)(0));
#if WEIR_DIM == 3
    const double inside = fmax(fmax(q.x, q.y), q.z);
#else
    const double inside = fmax(q.x, q.y);
#endif
    return inside > 0 ? norm_of(out) : inside;
}
WEIR_FN double shape_sphere(double4 x, double4 centre, double radius) { return norm_of(x - centre) - radius; }
WEIR_FN double shape_plane(double4 x, double4 point, double4 normal) { return dot_of(normal, x - point); }
WEIR_FN double shape_wave(double4 x, double level, double amplitude, double k) {
    const double slope = amplitude * k * sin(k * x.x);
    return (x.y - level - amplitude * cos(k * x.x)) / sqrt(1 + slope * slope);
}
WEIR_FN double shape_capsule(double4 x, double4 from, double4 to, double radius) {
    const double4 axis = to - from;
    const double length2 = dot_of(axis, axis), s = length2 > 0 ? clamp(dot_of(x - from, axis) / length2, 0.0, 1.0) : 0.0;
    return norm_of(x - from - s * axis) - radius;
}
WEIR_FN double shape_cylinder(double4 x, double4 middle, double4 axis, double half_length, double radius) {
    const double4 y = x - middle;
    const double z = dot_of(y, axis), dz = fabs(z) - half_length, dr = norm_of(y - z * axis) - radius;
    return dz <= 0 || dr <= 0 ? fmax(dz, dr) : sqrt(dz * dz + dr * dr);
}
