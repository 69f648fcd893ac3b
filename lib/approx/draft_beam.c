/*
 * draft_beam.c - neighbouring rays against one voxel: draft_walk.h's arithmetic, number for number, with the rays in the innermost loops and
 * no branch in these, so that compilers use wide registers. A facet is so unpacked once for all of them.
 *
 * A ray is in a voxel exactly where the walk would come to it: the walk crosses the slices in order of t, at equal t the lower
 * axis first; so every crossing into the voxel must come before every crossing out of it.
 */
#include "approx/draft_beam.h"

#if ASET_WITH_DRAFTS

static void set_axis(draft_beam *restrict b, const aset_draft *draft, int a, const aset_real *restrict origins,
                     const aset_real *restrict directions) {
    aset_real *o = b->o[a], *d = b->d[a], *turned = b->turned[a], *from = b->from[a], *inverse = b->inverse[a];
    aset_real low = draft->low[a], per_size = draft->per_size[a];
    EACH_RAY(i) {
        draft_axis x = draft_axis_of(low, per_size, origins[i], directions[i]);
        o[i] = x.o;
        d[i] = x.d;
        turned[i] = x.d < 0 ? R(1) : R(0);
        from[i] = x.from;
        inverse[i] = x.inverse;
    }
}

void aset_draft_beam_start(draft_beam *beam, const aset_draft *draft, aset_real (*origins)[DRAFT_BEAM],
                           aset_real (*directions)[DRAFT_BEAM], const aset_real *t_max, uint32_t n) {
    beam->draft = draft;
    beam->n_visited = 0;
    beam->n_left = n;
    for (int a = 0; a < 3; a++) {
        set_axis(beam, draft, a, origins[a], directions[a]);
    }
    EACH_RAY(i) {
        beam->t_max[i] = t_max[i];
        beam->end[i] = 0;
        beam->left[i] = (uint32_t)i < n ? R(1) : R(0);
        beam->cover[i] = draft_cover_of(beam->layers[i]);
    }
}

/* Where a ray crosses into a voxel's slices on one axis, from low columns on. Turned, these are 4 - 8 turned further. */
#define PLANE_IN(b, a, i, low) ((low) - (b)->turned[a][i] * (2 * (low) + 4))
#define CROSSING(b, a, i, plane) (((plane) - (b)->from[a][i]) * (b)->inverse[a][i])

/*
 * Rays are looked at in parts: those of which no ray comes through a voxel are left out. As many floats as a wide register holds; a
 * constant where the work is called.
 */
#define WIDE_PART 8
#if defined(__AVX__)
#define PART WIDE_PART
#else
#define PART 4
#endif
#define EACH_OF_PART(k) for (int k = 0; k < part; k++)

/* Which rays of a part, neither done nor ended before, come through the voxel; how many. */
DRAFT_WORK int32_t come_through(int32_t *restrict through, const draft_beam *restrict b, const aset_real low[3], int first, int part) {
    aset_real low_x = low[0], low_y = low[1], low_z = low[2];
    int32_t n = 0;
    EACH_OF_PART(k) {
        int i = first + k;
        aset_real plane_x = PLANE_IN(b, 0, i, low_x), plane_y = PLANE_IN(b, 1, i, low_y), plane_z = PLANE_IN(b, 2, i, low_z);
        aset_real x = CROSSING(b, 0, i, plane_x), out_x = CROSSING(b, 0, i, plane_x + 4);
        aset_real y = CROSSING(b, 1, i, plane_y), out_y = CROSSING(b, 1, i, plane_y + 4);
        aset_real z = CROSSING(b, 2, i, plane_z), out_z = CROSSING(b, 2, i, plane_z + 4);
        int32_t in_order = (x <= out_y) & (x <= out_z) & (y < out_x) & (y <= out_z) & (z < out_x) & (z < out_y);
        aset_real in = real_max(x, real_max(y, z)), out = real_min(out_x, real_min(out_y, out_z));
        int32_t in_time = (in < b->t_max[i]) & (out > 0);
        through[i] = in_order & in_time & (b->left[i] > 0);
        n += through[i];
    }
    return n;
}

/* What all rays have of one facet. */
typedef struct meetings {
    aset_real t[DRAFT_BEAM], rate[DRAFT_BEAM], u[DRAFT_BEAM], v[DRAFT_BEAM];
    uint16_t footprint;
    bool down;
} meetings;

/*
 * Where on an axis a footprint may stop a ray, from its voxel's middle: within ALONE of the middles of the outermost columns, on that
 * axis, that it covers anything of. draft_soft_cover gives COVER_LEAST of a lone column at 0.835.
 */
#define ALONE R(0.84)
#define LOW_OF(i) ((i) > 0 ? (i) - R(1.5) - ALONE : -(2 + BEYOND_SIDES))
#define HIGH_OF(i) ((i) < 3 ? (i) - R(1.5) + ALONE : 2 + BEYOND_SIDES)

/* By a bit for each column. */
static const aset_real span_low[16] = {0, LOW_OF(0), LOW_OF(1), LOW_OF(0), LOW_OF(2), LOW_OF(0), LOW_OF(1), LOW_OF(0),
                                       LOW_OF(3), LOW_OF(0), LOW_OF(1), LOW_OF(0), LOW_OF(2), LOW_OF(0), LOW_OF(1), LOW_OF(0)};
static const aset_real span_high[16] = {0, HIGH_OF(0), HIGH_OF(1), HIGH_OF(1), HIGH_OF(2), HIGH_OF(2), HIGH_OF(2), HIGH_OF(2),
                                        HIGH_OF(3), HIGH_OF(3), HIGH_OF(3), HIGH_OF(3), HIGH_OF(3), HIGH_OF(3), HIGH_OF(3), HIGH_OF(3)};

/* The columns along u, or v, of which a footprint covers anything. */
static uint32_t columns_u(uint32_t footprint) {
    uint32_t two_rows = footprint | footprint >> 8;
    return (two_rows | two_rows >> 4) & 15u;
}

static uint32_t columns_v(uint32_t footprint) {
    uint32_t pairs = footprint | footprint >> 1, any = (pairs | pairs >> 2) & 0x1111u; /* the lowest bit of each row */
    return (any | any >> 3 | any >> 6 | any >> 9) & 15u;
}

/* A facet as the rays meet it: on axis a, over u and v; the middle of its voxel; where it may stop a ray. */
typedef struct plane {
    unsigned a, u, v;
    aset_real height, slope_u, slope_v, middle_a, middle_u, middle_v;
    aset_real low_u, high_u, low_v, high_v;
} plane;

/* The rays of a part that come through against a facet; those of which it may stop anything get its bit. */
DRAFT_WORK void meet_facet(meetings *restrict m, int32_t *restrict met, int32_t bit, const draft_beam *restrict b,
                           const int32_t *restrict through, const plane *restrict p, int first, int part) {
    const aset_real *oa = b->o[p->a], *ou = b->o[p->u], *ov = b->o[p->v], *da = b->d[p->a], *du = b->d[p->u], *dv = b->d[p->v];
    aset_real ma = p->middle_a, mu = p->middle_u, mv = p->middle_v, height = p->height, slope_u = p->slope_u, slope_v = p->slope_v;
    aset_real low_u = p->low_u, high_u = p->high_u, low_v = p->low_v, high_v = p->high_v;
    EACH_OF_PART(k) {
        int i = first + k;
        aset_real qa = oa[i] - ma, qu = ou[i] - mu, qv = ov[i] - mv;
        aset_real rate = da[i] - slope_u * du[i] - slope_v * dv[i];
        aset_real t = (height + slope_u * qu + slope_v * qv - qa) / rate;
        aset_real ha = qa + t * da[i], hu = qu + t * du[i], hv = qv + t * dv[i];
        int32_t beside = (hu >= low_u) & (hu <= high_u) & (hv >= low_v) & (hv <= high_v) & (ha >= -(2 + BEYOND_HEIGHT)) &
                         (ha <= 2 + BEYOND_HEIGHT);
        m->t[i] = t;
        m->rate[i] = rate;
        m->u[i] = hu + 2;
        m->v[i] = hv + 2;
        met[i] |= -(beside & (t > b->end[i]) & (t < b->t_max[i]) & through[i]) & bit;
    }
}

DRAFT_WORK void find_plane(plane *p, meetings *m, const aset_draft *draft, const aset_real middle[3], uint32_t number) {
    const facet f = facet_read(draft, number);
    uint32_t in_u = columns_u(f.footprint), in_v = columns_v(f.footprint);
    p->a = (unsigned)f.axis;
    p->u = facet_next(p->a);
    p->v = facet_next(p->u);
    p->height = f.height - 2;
    p->slope_u = f.slope_u;
    p->slope_v = f.slope_v;
    p->middle_a = middle[p->a];
    p->middle_u = middle[p->u];
    p->middle_v = middle[p->v];
    p->low_u = span_low[in_u];
    p->high_u = span_high[in_u];
    p->low_v = span_low[in_v];
    p->high_v = span_high[in_v];
    m->footprint = (uint16_t)f.footprint;
    m->down = f.down;
}

/* Those of a part's rays that are set, first to last; how many. */
DRAFT_WORK uint32_t list_set(uint32_t *restrict list, const int32_t *restrict set, int first, int part) {
    uint32_t n = 0;
    for (int i = first; i < first + part; i++) {
        list[n] = (uint32_t)i;
        n += (uint32_t)(set[i] != 0);
    }
    return n;
}

/* Lays on ray i what it has met of the facets from number first on, bit k for the k-th, nearest first. True: the ray is done. */
DRAFT_WORK bool lay(draft_cover *cover, const meetings *m, uint32_t i, uint32_t met, uint32_t first) {
    while (met != 0) {
        uint32_t k = bits_lowest(met);
        for (uint32_t rest = met & (met - 1); rest != 0; rest &= rest - 1) {
            uint32_t other = bits_lowest(rest);
            k = m[other].t[i] < m[k].t[i] ? other : k;
        }
        draft_meeting one = {m[k].t[i], m[k].u[i], m[k].v[i], first + k, m[k].footprint, (m[k].rate[i] > 0) != m[k].down};
        if (aset_draft_cover_lay(cover, &one)) {
            return true;
        }
        met &= ~(UINT32_C(1) << k);
    }
    return false;
}

DRAFT_WORK bool visit(draft_beam *beam, const uint32_t at[3], uint32_t dense, unsigned k, int part) {
    int32_t through[DRAFT_BEAM];
    uint32_t list[DRAFT_BEAM], first, end;
    meetings m[DRAFT_FACETS_MAX];
    int32_t met[DRAFT_BEAM] = {0};
    const aset_real low[3] = {(aset_real)(int32_t)(at[0] * 16 + k % 4 * 4), (aset_real)(int32_t)(at[1] * 16 + k / 4 % 4 * 4),
                              (aset_real)(int32_t)(at[2] * 16 + k / 16 * 4)};
    int32_t n_through[DRAFT_BEAM], n_all = 0; /* of a part: by its first ray */
    for (int from = 0; from < DRAFT_BEAM; from += part) {
        n_through[from] = come_through(through, beam, low, from, part);
        n_all += n_through[from];
    }
    /* A hostile draft may lie where the band's draft lay, with its check sum: no voxel that it does not have. */
    if (n_all == 0 || dense >= beam->draft->n_blocks || (draft_marks(beam->draft, dense) >> k & 1u) == 0) {
        return false;
    }
    const aset_real middle[3] = {low[0] + 2, low[1] + 2, low[2] + 2};
    beam->n_visited += (uint32_t)n_all;
    draft_find_facets(beam->draft, dense, bits_count(draft_marks(beam->draft, dense) & ((UINT64_C(1) << k) - 1)), &first, &end);
    for (uint32_t f = 0; f < end - first; f++) {
        plane p;
        find_plane(&p, &m[f], beam->draft, middle, first + f);
        for (int from = 0; from < DRAFT_BEAM; from += part) {
            if (n_through[from] > 0) {
                meet_facet(&m[f], met, (int32_t)(1u << f), beam, through, &p, from, part);
            }
        }
    }
    for (int from = 0; from < DRAFT_BEAM; from += part) {
        uint32_t n = n_through[from] > 0 ? list_set(list, met, from, part) : 0;
        for (uint32_t j = 0; j < n; j++) {
            uint32_t i = list[j];
            beam->n_left -= lay(&beam->cover[i], m, i, (uint32_t)met[i], first);
            beam->left[i] = beam->cover[i].left;
            beam->end[i] = draft_cover_end(&beam->cover[i]);
        }
    }
    return beam->n_left == 0;
}

DRAFT_WIDE_WORK bool visit_wide(draft_beam *beam, const uint32_t at[3], uint32_t dense, unsigned k) {
    return visit(beam, at, dense, k, WIDE_PART);
}

bool aset_draft_beam_visit(draft_beam *beam, const uint32_t at[3], uint32_t dense, unsigned k) {
    if (DRAFT_HAS_WIDE) {
        return visit_wide(beam, at, dense, k);
    }
    return visit(beam, at, dense, k, PART);
}

#endif
