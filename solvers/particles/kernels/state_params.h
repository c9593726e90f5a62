/* What the passes over the state in double precision read. Plain C, compiled as C++ and as OpenCL C. */
typedef struct {
    double centre[3];              /* where the coordinates of the pair passes start [m] */
    double keep_lo[3], keep_hi[3]; /* where particles are kept [m] */
    double lo[3], period[3];       /* of axes that repeat; 0: the axis does not [m] */
    double exit_lo[3], exit_hi[3]; /* beyond these a particle has left [m] */
    double gravity[3];             /* of the effect "gravity" [m/s^2] */
    double field_centre[3];        /* of the effect "central_force" [m] */
} StateParams;
