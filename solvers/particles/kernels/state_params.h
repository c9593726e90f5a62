/* Parameters of the double-precision passes over the state. Plain C, compiled as C++ and as OpenCL C. */
typedef struct {
    double centre[3];              /* origin of the coordinates of the pair passes [m] */
    double keep_lo[3], keep_hi[3]; /* bounds of particle positions [m] */
    double lo[3], period[3];       /* of periodic axes; 0: the axis is not periodic [m] */
    double exit_lo[3], exit_hi[3]; /* beyond these a particle has left [m] */
    double gravity[3];             /* of the effect "gravity" [m/s^2] */
    double field_centre[3];        /* of the effect "central_force" [m] */
    double least_back;             /* corrections by walls below this are rounding [m] */
    double margin, feel, reach;    /* minimum distance to solids; offset of normal differences; range of solids [m] */
} StateParams;

/* Pose of a solid: x_world = centre + R (x_rest - centre) + offset, and its velocity there (geometry/motion.hpp). */
typedef struct {
    double centre[3], offset[3], velocity[3]; /* [m], [m], [m/s] */
    double rotation[9], spin[3];              /* rows of R; [rad/s] */
    double no_slip;                           /* 1: no slip */
} SolidPose;

/* WallParams without walls, in double precision: for the terms of solids (solid_terms.cl). */
typedef struct {
    double inv_h, fraction[WEIR_WALL_TERMS], slope[WEIR_WALL_TERMS];
} SolidSeries;
