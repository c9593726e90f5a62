/* What the passes over the state in double precision read. Plain C, compiled as C++ and as OpenCL C. */
typedef struct {
    double centre[3];              /* where the coordinates of the pair passes start [m] */
    double keep_lo[3], keep_hi[3]; /* where particles are kept [m] */
    double lo[3], period[3];       /* of axes that repeat; 0: the axis does not [m] */
    double exit_lo[3], exit_hi[3]; /* beyond these a particle has left [m] */
    double gravity[3];             /* of the effect "gravity" [m/s^2] */
    double field_centre[3];        /* of the effect "central_force" [m] */
    double least_back;             /* what walls put back by less is rounding [m] */
    double margin, feel, reach;    /* no particle comes closer to a solid; normals are felt over this; closer than this solids act [m] */
} StateParams;

/* Where a solid is: x_world = centre + R (x_rest - centre) + offset, and its velocity there (geometry/motion.hpp). */
typedef struct {
    double centre[3], offset[3], velocity[3]; /* [m], [m], [m/s] */
    double rotation[9], spin[3];              /* rows of R; [rad/s] */
    double no_slip;                           /* 1: the liquid sticks to it */
} SolidPose;

/* WallParams without its walls, in double precision: what solids add (solid_terms.cl). */
typedef struct {
    double inv_h, fraction[WEIR_WALL_TERMS], slope[WEIR_WALL_TERMS];
} SolidSeries;
