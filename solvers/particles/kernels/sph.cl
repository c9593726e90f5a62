/* The passes of SPH (Mueller, Charypar & Gross 2003): sph_pair.inl over every particle's neighbours. Positions are float4 with 1 / rho
   as their fourth number, velocities with pressure, or with the density's excess over rho0. Defines: WEIR_CONTINUITY (density by the
   continuity equation; otherwise by summation), WEIR_TAIT, WEIR_PULL (pressure may be negative), WEIR_WALL_FORCES, and the effects of
   the scene: WEIR_DIFFUSION of density, WEIR_ARTIFICIAL viscosity, WEIR_VISCOUS, WEIR_TENSION. */

#ifndef WEIR_CONTINUITY
/* rho_i = sum_j m W                                                                               Mueller et al. 2003, eq. 3 */
__kernel void sph_densities(int count, int stride, __constant SphParams* p, __constant WallParams* walls, __global const float4* terms,
                            float wall_rho, __global const float* rests, __global const float4* at, __global const int* neighbours, __global const int* list,
                            __global const int* order, __global double* density) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i];
    float rho = p->self;
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const float4 d = APART(me, at[list[(size_t)k * stride + i]]);
        rho = sph_add_density(rho, DISTANCE2(d, p), p);
    }
#ifdef WEIR_RESTS
    wall_rho *= rests[i];
#endif
    density[order[i]] = (double)(rho + wall_rho * walls_at(me, walls, terms, i).w);
}
#endif

WEIR_FN float4 velocity_of(int i, int stride, __global const double* v, double more) {
    float4 u = (float4)((float)v[i], (float)v[(size_t)stride + i], 0.0f, (float)more);
#if WEIR_DIM == 3
    u.z = (float)v[(size_t)2 * stride + i];
#endif
    return u;
}

/* The equation of state, and what the force pass reads. tait: (c^2 rho0 / gamma, gamma); linear: (c^2, 1)               eq. 12 */
__kernel void find_pressures(int count, int stride, double2 state, double rest, __global const float* rests, __global const int* order, __global const double* v,
                             __global const double* density, __global double* pressure, __global float4* at,
                             __global float4* velocities) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const int i = order[k];
#ifdef WEIR_RESTS
    rest *= rests[k];
    state.x *= state.y == 1 ? 1 : rests[k]; /* c^2 rho0 / gamma */
#endif
#ifdef WEIR_TAIT
    double p = state.x * (pow(density[i] / rest, state.y) - 1);
#else
    double p = state.x * (density[i] - rest);
#endif
#ifndef WEIR_PULL
    p = p < 0 ? 0 : p;
#endif
    pressure[i] = p;
    at[k].w = (float)(1 / density[i]);
    velocities[k] = velocity_of(i, stride, v, p);
}

/* Acceleration by all forces between particles and of walls. With density by summation the pair forces are the gradient of the energy
   sum_i m e(rho_i), e' = p / rho^2 (Monaghan 1992, eq. 3.3); otherwise the form consistent with the continuity equation. */
__kernel void sph_forces(int count, int stride, __constant SphParams* p, __constant WallParams* walls, __global const float4* terms,
                         __global const float4* at, __global const float4* velocities, __global const int* neighbours,
                         __global const int* list, __global float4* acceleration) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i], u = velocities[i], w = walls_at(me, walls, terms, i);
    const float own = (u.w + u.w) * me.w; /* walls have the particle's own pressure: no gradient through them */
    float ax = -own * w.x, ay = -own * w.y, az = -own * w.z;
#ifdef WEIR_WALL_FORCES
    if (w.w > 0) {
        const float x[3] = {me.x, me.y, me.z}, v[3] = {u.x, u.y, u.z};
        float more[3];
        sph_wall_force(x, v, u.w, w.w, walls, p, more);
        ax += more[0], ay += more[1], az += more[2];
    }
#endif
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const int j = list[(size_t)k * stride + i];
        const float4 other = at[j], v = velocities[j], d = APART(me, other), du = u - v;
        const float r2 = DISTANCE2(d, p), volumes = me.w * other.w;
#ifdef WEIR_CONTINUITY
        float pressures = (u.w + v.w) * volumes, push;
#else
        float pressures = FMA(v.w * other.w, other.w, u.w * me.w * me.w), push;
#endif
#ifdef WEIR_ARTIFICIAL
        pressures = sph_add_artificial(pressures, r2, dot3(du.x, du.y, du.z, d.x, d.y, d.z), 0.5f * (me.w + other.w), p);
#endif
#ifdef WEIR_VISCOUS
        const float drag = sph_drag(r2, volumes, p);
        ax = FNMA(drag, du.x, ax);
        ay = FNMA(drag, du.y, ay);
        az = FNMA(drag, du.z, az);
#endif
        push = sph_push(r2, pressures, p);
        ax = FMA(push, d.x, ax);
        ay = FMA(push, d.y, ay);
        az = FMA(push, d.z, az);
    }
    acceleration[i] = (float4)(ax, ay, az, 0.0f);
}

#ifdef WEIR_STICKY_SOLIDS
/* Drag of a no-slip solid, as of a wall: 2 nu plane / phi along its surface (Morris et al. 1997, sec. 3.2; sph_wall_force). */
__kernel void drag_at_solids(int count, int stride, __constant StateParams* s, __constant SphParams* p, double drag2,
                             __global const SolidPose* poses, __global const float4* at, __global const uchar* near_solid,
                             __global const float4* terms, __global const int* order, __global const double* v,
                             __global float4* acceleration) {
    const int k = get_global_id(0);
    if (k >= count || !near_solid[k]) return;
    const double4 x = world_of(at[k], s);
    __global const SolidPose* solid = poses + nearest_solid(x, poses);
    const double4 pull = (double4)(terms[k].x, terms[k].y, terms[k].z, 0); /* opposite to the normal; its length is the integral over the plane */
    const double plane = norm_of(pull);
    if (solid->no_slip == 0 || plane == 0) return;
    const int i = order[k];
    const double4 own = (double4)(v[i], v[(size_t)stride + i], WEIR_DIM == 3 ? v[(size_t)(WEIR_DIM - 1) * stride + i] : 0, 0);
    const double4 slip = solid_velocity(x, solid) - own, along = slip - dot_of(slip, pull) / (plane * plane) * pull;
    const double drag = drag2 * plane / fmax(solids_distance(x, poses), (double)p->closest);
    acceleration[k] += (float4)((float)(drag * along.x), (float)(drag * along.y), (float)(drag * along.z), 0);
}
#endif

#ifdef WEIR_TENSION
/* Surface normals in the form of sph_normal, and their squares. Liquid is assumed behind walls. */
__kernel void normals(int count, int stride, __constant SphParams* p, __constant WallParams* walls, __global const float4* terms,
                      __global const float4* at, __global const int* neighbours, __global const int* list, __global float4* normal) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i];
    float4 q = walls_at(me, walls, terms, i);
    q.w = 0;
    for (int k = 0; k < neighbours[i]; ++k) {
        const float4 other = at[list[(size_t)k * stride + i]], d = APART(me, other);
        const float f = sph_colour(DISTANCE2(d, p), other.w, p);
        q.x = FMA(f, d.x, q.x);
        q.y = FMA(f, d.y, q.y);
        q.z = FMA(f, d.z, q.z);
    }
    q *= sph_normal(dot3(q.x, q.y, q.z, q.x, q.y, q.z), p);
    q.w = dot3(q.x, q.y, q.z, q.x, q.y, q.z);
    normal[i] = q;
}

/* v += dt a, a by surface tension */
__kernel void tension(int count, int stride, __constant SphParams* p, double dt, __global const float4* at, __global const float4* normal,
                      __global const int* neighbours, __global const int* list, __global const int* order, __global double* v) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i], q = normal[i];
    float4 a = (float4)(0.0f);
    for (int k = 0; k < neighbours[i]; ++k) {
        const int j = list[(size_t)k * stride + i];
        const float4 other = at[j], n = normal[j], d = APART(me, other);
        const float f = sph_tension(DISTANCE2(d, p), me.w * other.w, p), both = q.w + n.w;
        const float own = dot3(q.x, q.y, q.z, d.x, d.y, d.z), others = dot3(n.x, n.y, n.z, d.x, d.y, d.z);
        a += f * (both * d - own * q - others * n);
    }
    add_change(i, stride, dt, a, order, v);
}
#endif

/* The forces of the scene, then v += dt a */
__kernel void kick(int count, int stride, __constant StateParams* s, double dt, double pull, __global const int* order,
                   __global const double* x, __global const float4* acceleration, __global double* v) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const int i = order[k];
    const float4 a = acceleration[k];
    const float by[3] = {a.x, a.y, a.z};
    for (int axis = 0; axis < WEIR_DIM; ++axis) {
        const size_t at = (size_t)axis * stride + i;
        v[at] = forced(v[at], x[at], dt, pull, s, axis) + dt * (double)by[axis];
    }
}

/* Squares of the accelerations by pressure, viscosity and walls. */
__kernel void accelerations(int count, __global const float4* acceleration, __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double largest = 0;
    for (int k = get_global_id(0); k < count; k += get_global_size(0)) {
        const float4 a = acceleration[k];
        largest = larger((double)a.x * a.x + (double)a.y * a.y + (double)a.z * a.z, largest);
    }
    reduce_parts(largest, 0, largests, sums, parts);
}

#ifdef WEIR_CONTINUITY
/* The new velocities and the density's excess, for the density rate. */
__kernel void load_excess(int count, int stride, double rho0, __global const float* rests, __global const int* order, __global const double* v,
                          __global const double* density, __global float4* velocities) {
    const int k = get_global_id(0);
    if (k >= count) return;
#ifdef WEIR_RESTS
    rho0 *= rests[k];
#endif
    velocities[k] = velocity_of(order[k], stride, v, density[order[k]] - rho0);
}

/* d rho / dt = rate, from the new velocities and the old positions (Colagrossi & Landrini 2003, eq. 10). The image velocity behind a
   wall is opposite to the particle's: the work of the wall's pressure then equals the particle's loss of volume. */
__kernel void advance_densities(int count, int stride, __constant StateParams* s, __global const SolidPose* poses,
                                __global const uchar* near_solid, __constant SphParams* p, __constant WallParams* walls,
                                __global const float4* terms, double dt, double rho0, __global const float4* at,
                                __global const float4* velocities, __global const int* neighbours, __global const int* list,
                                __global const int* order, __global double* density) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i], u = velocities[i], w = walls_at(me, walls, terms, i);
    float rate = 2 * dot3(w.x, w.y, w.z, u.x, u.y, u.z), spread = 0;
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const int j = list[(size_t)k * stride + i];
        const float4 other = at[j], v = velocities[j], d = APART(me, other), du = u - v;
        const float r2 = DISTANCE2(d, p);
        rate += sph_rate(r2, dot3(du.x, du.y, du.z, d.x, d.y, d.z), other.w, p);
#ifdef WEIR_DIFFUSION
        spread += sph_diffusion(r2, v.w - u.w + sph_layers(d.x, d.y, d.z, p), other.w, p);
#endif
    }
    const double rho = density[order[i]];
    float whole = rate / me.w + spread;
#ifdef WEIR_MOVING_SOLIDS
    if (near_solid[i]) { /* images behind a moving solid move with it */
        const double4 x = world_of(me, s);
        const double4 u_solid = solid_velocity(x, poses + nearest_solid(x, poses));
        whole -= (float)(2 * rho * dot_of(u_solid, (double4)(terms[i].x, terms[i].y, terms[i].z, 0)));
    }
#endif
    density[order[i]] = density_kept(rho * density_growth(dt * (double)whole / rho), rho0);
}
#endif

/* x += dt v. A particle that would enter a wall or a solid is moved back and loses its normal velocity. */
__kernel void drift(int count, int stride, __constant StateParams* s, __global const SolidPose* poses, double dt, __global uint* corrections,
                    __global double* x, __global double* v) {
    const int i = get_global_id(0);
    if (i >= count) return;
    double free[3], end[3];
    for (int axis = 0; axis < WEIR_DIM; ++axis) {
        const size_t at = (size_t)axis * stride + i;
        free[axis] = end[axis] = x[at] + dt * v[at];
    }
    keep_and_count(end, s, poses, corrections);
    for (int axis = 0; axis < WEIR_DIM; ++axis) {
        const size_t at = (size_t)axis * stride + i;
        if (end[axis] != free[axis]) v[at] = (end[axis] - x[at]) / dt;
        x[at] = end[axis];
    }
}
