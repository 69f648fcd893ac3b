/*
 * draft_beam.c - eight rays against one voxel: draft_ray.c's arithmetic, number for number, with the rays in the innermost loops and
 * no branch in these, so that compilers use wide registers. A facet is so unpacked once for eight rays.
 *
 * A ray is in a voxel exactly where the walk would come to it: the walk crosses the slices in order of t, at equal t the lower
 * axis first; so every crossing into the voxel must come before every crossing out of it.
 */
#include "approx/draft_beam.h"

#if ASET_WITH_DRAFTS

#define EACH(i) for (int i = 0; i < DRAFT_BEAM; i++)

static void set_axis(draft_beam *restrict b, const aset_draft *draft, int a, const aset_real *restrict origins,
                     const aset_real *restrict directions) {
    aset_real *o = b->o[a], *d = b->d[a], *turned = b->turned[a], *from = b->from[a], *inverse = b->inverse[a];
    aset_real low = draft->low[a], per_size = draft->per_size[a];
    EACH(i) {
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
    EACH(i) {
        beam->t_max[i] = t_max[i];
        beam->end[i] = 0;
        beam->left[i] = (uint32_t)i < n ? R(1) : R(0);
        beam->cover[i] = draft_cover_of(beam->layers[i]);
    }
}

/* Where a ray crosses into a voxel's slices on one axis, from low columns on. Turned, these are 4 - 8 turned further. */
#define PLANE_IN(b, a, i, low) ((low) - (b)->turned[a][i] * (2 * (low) + 4))
#define CROSSING(b, a, i, plane) (((plane) - (b)->from[a][i]) * (b)->inverse[a][i])

/* Which rays, neither done nor ended before, come through the voxel; how many. */
static int32_t come_through(int32_t *restrict through, const draft_beam *restrict b, const aset_real low[3]) {
    aset_real low_x = low[0], low_y = low[1], low_z = low[2];
    int32_t n = 0;
    EACH(i) {
        aset_real plane_x = PLANE_IN(b, 0, i, low_x), plane_y = PLANE_IN(b, 1, i, low_y), plane_z = PLANE_IN(b, 2, i, low_z);
        aset_real x = CROSSING(b, 0, i, plane_x), out_x = CROSSING(b, 0, i, plane_x + 4);
        aset_real y = CROSSING(b, 1, i, plane_y), out_y = CROSSING(b, 1, i, plane_y + 4);
        aset_real z = CROSSING(b, 2, i, plane_z), out_z = CROSSING(b, 2, i, plane_z + 4);
        int32_t in_order = (x <= out_y) & (x <= out_z) & (y < out_x) & (y <= out_z) & (z < out_x) & (z < out_y);
        int32_t in_time = (x < b->t_max[i]) & (y < b->t_max[i]) & (z < b->t_max[i]) & (out_x > 0) & (out_y > 0) & (out_z > 0);
        through[i] = in_order & in_time & (b->left[i] > 0);
        n += through[i];
    }
    return n;
}

/* What all rays have of one facet. */
typedef struct meetings {
    aset_real t[DRAFT_BEAM], rate[DRAFT_BEAM], u[DRAFT_BEAM], v[DRAFT_BEAM];
    int32_t met[DRAFT_BEAM];
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

/* The rays that come through against a facet; met: those of which it may stop anything. */
static void meet_facet(meetings *restrict m, const draft_beam *restrict b, const int32_t *restrict through, const aset_real middle[3],
                       uint32_t number) {
    static const unsigned char next[4] = {1, 2, 0, 0};
    uint64_t record = facet_record(b->draft, number);
    uint32_t surface = facet_surface(b->draft, record), footprint = facet_footprint(b->draft, record);
    aset_real height = facet_height(b->draft, record) - 2;
    aset_real slope_u = surface_slope_u(surface), slope_v = surface_slope_v(surface);
    unsigned a = surface_axis(surface), u = next[a], v = next[u];
    const aset_real *oa = b->o[a], *ou = b->o[u], *ov = b->o[v], *da = b->d[a], *du = b->d[u], *dv = b->d[v];
    aset_real ma = middle[a], mu = middle[u], mv = middle[v];
    uint32_t in_u = columns_u(footprint), in_v = columns_v(footprint);
    aset_real low_u = span_low[in_u], high_u = span_high[in_u], low_v = span_low[in_v], high_v = span_high[in_v];
    m->footprint = (uint16_t)footprint;
    m->down = surface_down(surface);
    EACH(i) {
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
        m->met[i] = beside & (t > b->end[i]) & (t < b->t_max[i]) & through[i];
    }
}

/* Those of the rays that are set, first to last; how many. */
static uint32_t list_set(uint32_t *restrict list, const int32_t *restrict set) {
    uint32_t n = 0;
    EACH(i) {
        list[n] = (uint32_t)i;
        n += (uint32_t)(set[i] != 0);
    }
    return n;
}

/* Lays on ray i what it has met of the facets from number first on, bit k for the k-th, nearest first. True: the ray is done. */
static bool lay(draft_cover *cover, const meetings *m, uint32_t i, uint32_t met, uint32_t first) {
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

bool aset_draft_beam_visit(draft_beam *beam, const uint32_t at[3], uint32_t dense, unsigned k) {
    int32_t through[DRAFT_BEAM];
    uint32_t list[DRAFT_BEAM], first, end;
    meetings m[DRAFT_FACETS_MAX];
    int32_t met[DRAFT_BEAM] = {0};
    const aset_real low[3] = {(aset_real)(int32_t)(at[0] * 16 + k % 4 * 4), (aset_real)(int32_t)(at[1] * 16 + k / 4 % 4 * 4),
                              (aset_real)(int32_t)(at[2] * 16 + k / 16 * 4)};
    int32_t n_through = come_through(through, beam, low);
    /* A hostile draft may lie where the band's draft lay, with its check sum: no voxel that it does not have. */
    if (n_through == 0 || dense >= beam->draft->n_blocks || (draft_marks(beam->draft, dense) >> k & 1u) == 0) {
        return false;
    }
    const aset_real middle[3] = {low[0] + 2, low[1] + 2, low[2] + 2};
    beam->n_visited += (uint64_t)n_through;
    draft_find_facets(beam->draft, dense, bits_count(draft_marks(beam->draft, dense) & ((UINT64_C(1) << k) - 1)), &first, &end);
    for (uint32_t f = 0; f < end - first; f++) {
        meet_facet(&m[f], beam, through, middle, first + f);
        EACH(i) {
            met[i] |= m[f].met[i] << f;
        }
    }
    uint32_t n = list_set(list, met);
    for (uint32_t j = 0; j < n; j++) {
        uint32_t i = list[j];
        beam->n_left -= lay(&beam->cover[i], m, i, (uint32_t)met[i], first);
        beam->left[i] = beam->cover[i].left;
        beam->end[i] = draft_cover_end(&beam->cover[i]);
    }
    return beam->n_left == 0;
}

#endif
