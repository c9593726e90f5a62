/* Columns of the domain along gravity, in which the weight above a particle is counted, and what follows from it. Plain C, compiled as C++
 * and as OpenCL C. */
#define WEIR_SHIFT_PIECES 128
typedef struct {
    double lo[3];                        /* of the domain [m] */
    double per_cell[3];                  /* 1 / size of a cell: one spacing along gravity, four across [1/m] */
    int cells[3], axis;                  /* numbers of cells, and the axis of gravity */
    int falls;                           /* 1: gravity points to higher indices of that axis */
    double depth_of_one;                 /* depth per particle above: its liquid's volume over the column's area [m] */
    double pieces_per_depth;             /* of the table [1/m] */
    double expansion;                    /* the liquid's density over the vapour's */
    double shift[WEIR_SHIFT_PIECES + 1]; /* at equal intervals of depth: increase of the boiling enthalpy relative to zero depth [J/kg] */
} VapourParams;
