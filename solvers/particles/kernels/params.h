/* Numbers that the pair physics reads; every pass has one copy. SCALAR is float or double. The same text is compiled as C++ and OpenCL C,
   so: plain C, no include guard (it is included once for each SCALAR, each time inside a namespace of its own). */

#define WEIR_WALL_TERMS 14

/* The walls of the domain as the kernel sees them: planes at lo[a] and hi[a] (a side that is no wall stands at -+1e30). */
typedef struct {
    SCALAR lo[3], hi[3];              /* walls [m] */
    SCALAR keep_lo[3], keep_hi[3];    /* where particles are kept: a hair inside the walls [m] */
    SCALAR inv_h;                     /* 1 / support [1/m] */
    SCALAR facing;                    /* 1: how solids face the walls counts for what each hides of the other; 0: it does not */
    SCALAR fraction[WEIR_WALL_TERMS]; /* u^2 T_k(2u - 1) coefficients, u = 1 - s/h, of the density kernel's part behind a wall [1] */
    SCALAR slope[WEIR_WALL_TERMS];    /* the same for the gradient kernel's integral over the wall's plane [1/m] */
} WallParams;

typedef struct {
    SCALAR h, h2;       /* support and its square [m], [m^2] */
    SCALAR guard;       /* added to r^2, so that coincident particles stay finite [m^2] */
    SCALAR self;        /* m W(0) / rho0: what a particle adds to its own density [1] */
    SCALAR density;     /* factor of the density kernel over rho0 / m */
    SCALAR gradient;    /* factor of the gradient kernel over rho0 / m */
    SCALAR cfm;         /* constraint force mixing, epsilon of eq. 11 [1/m^2] */
    SCALAR relaxation;  /* factor of every correction [1] */
    SCALAR corr_k;      /* artificial pressure: k of eq. 13 as a length squared [m^2] */
    SCALAR corr_inv_wq; /* 1 / W(dq) in units of the density kernel's factor */
} PbfParams;

typedef struct {
    SCALAR h, h2, guard;
    SCALAR self;       /* m W(0) [kg/m^3] */
    SCALAR density;    /* factor of the density kernel times m */
    SCALAR gradient;   /* factor of the gradient kernel times m */
    SCALAR laplacian;  /* factor of the viscosity kernel's Laplacian times m */
    SCALAR wall_rho;   /* density of what stands behind walls [kg/m^3] */
    SCALAR viscosity;  /* dynamic viscosity mu [Pa s] */
    SCALAR artificial; /* artificial viscosity: alpha c h / 2 [m^2/s] */
    SCALAR soften;     /* keeps the artificial viscosity finite: 0.01 (h / 2)^2 [m^2] */
    SCALAR diffusion;  /* of density: 2 delta c h / 2 [m^2/s] */
    SCALAR layers[3];  /* gradient of the density of the liquid at rest, rho0 g / c^2 [kg/m^4] */
    SCALAR tension;    /* of the surface: sigma k times the factor of the stress's slope times m */
    SCALAR noise;      /* a gradient of the colour below this is disorder, not a surface [1/m] */
    SCALAR gravity[3]; /* by which the pressure goes on behind walls [m/s^2] */
    SCALAR per_depth;  /* 1 / (rho0 |g| d): the pressure of one spacing of depth [1/Pa]; 0: no gravity */
    SCALAR closest;    /* distance to a wall below which drag does not grow [m] */
    SCALAR stick[6];   /* 2 nu where the fluid sticks to a wall (x lo, x hi, y lo, ...), else 0 [m^2/s] */
    SCALAR slide[18];  /* velocity of the walls, three numbers each [m/s] */
} SphParams;

typedef struct {
    SCALAR h, h2, guard;
    SCALAR conduct; /* -2 V / (moment rho0) times the factor of the gradient kernel, so that theta over it is a rate of h, positive */
} HeatParams;

/* Walls as heat meets them: planes at lo[a] and hi[a] (a side that is no wall stands at -+1e15). */
typedef struct {
    SCALAR lo[3], hi[3];             /* [m] */
    SCALAR lo_theta[3], hi_theta[3]; /* where a wall is held at a temperature, that of the wall [W/m] */
    SCALAR closest;                  /* to a wall: what stands closer is taken to stand here [m] */
    int lo_held[3], hi_held[3];      /* 1: it is; 0: no heat passes */
} HeatWalls;
