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

static void set_axis(draft_beam *b, int a, int i, aset_real origin, aset_real direction) {
    aset_real o = (origin - b->draft->low[a]) * b->draft->per_size[a], d = direction * b->draft->per_size[a];
    bool turned = d < 0;
    aset_real inverse = 1 / (turned ? -d : d);
    b->o[a][i] = o;
    b->d[a][i] = d;
    b->turned[a][i] = turned ? R(1) : R(0);
    b->from[a][i] = turned ? -o : o;
    b->inverse[a][i] = inverse < REAL_MAX ? inverse : REAL_MAX;
}

void aset_draft_beam_start(draft_beam *beam, const aset_draft *draft, const aset_vec3 *origins, const aset_vec3 *directions,
                           const aset_real *t_max, uint32_t n) {
    beam->draft = draft;
    beam->n_visited = 0;
    beam->n_left = n;
    EACH(i) {
        uint32_t k = (uint32_t)i < n ? (uint32_t)i : 0;
        set_axis(beam, 0, i, origins[k].x, directions[k].x);
        set_axis(beam, 1, i, origins[k].y, directions[k].y);
        set_axis(beam, 2, i, origins[k].z, directions[k].z);
        beam->t_max[i] = t_max[k];
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
} meetings;

/* The rays that come through against one facet's plane. */
static int32_t meet_plane(meetings *restrict m, const draft_beam *restrict b, const int32_t *restrict through,
                          const aset_real middle[3], uint64_t record, uint32_t surface) {
    static const unsigned char next[4] = {1, 2, 0, 0};
    aset_real height = facet_height(b->draft, record) - 2;
    aset_real slope_u = surface_slope_u(surface), slope_v = surface_slope_v(surface);
    unsigned a = surface_axis(surface), u = next[a], v = next[u];
    const aset_real *oa = b->o[a], *ou = b->o[u], *ov = b->o[v], *da = b->d[a], *du = b->d[u], *dv = b->d[v];
    aset_real ma = middle[a], mu = middle[u], mv = middle[v];
    int32_t n = 0;
    EACH(i) {
        aset_real qa = oa[i] - ma, qu = ou[i] - mu, qv = ov[i] - mv;
        aset_real rate = da[i] - slope_u * du[i] - slope_v * dv[i];
        aset_real t = (height + slope_u * qu + slope_v * qv - qa) / rate;
        aset_real ha = qa + t * da[i], hu = qu + t * du[i], hv = qv + t * dv[i];
        int32_t beside = (hu >= -(2 + BEYOND_SIDES)) & (hu <= 2 + BEYOND_SIDES) & (hv >= -(2 + BEYOND_SIDES)) &
                         (hv <= 2 + BEYOND_SIDES) & (ha >= -(2 + BEYOND_HEIGHT)) & (ha <= 2 + BEYOND_HEIGHT);
        m->t[i] = t;
        m->rate[i] = rate;
        m->u[i] = hu + 2;
        m->v[i] = hv + 2;
        m->met[i] = beside & (t > b->end[i]) & (t < b->t_max[i]) & through[i];
        n += m->met[i];
    }
    return n;
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

/* What the rays have met of one voxel's facets. */
typedef struct voxel_meetings {
    draft_meeting found[DRAFT_BEAM][DRAFT_FACETS_MAX];
    int32_t n[DRAFT_BEAM];
} voxel_meetings;

static void meet_facet(voxel_meetings *v, const draft_beam *beam, const int32_t *through, const aset_real middle[3], uint32_t number) {
    meetings m;
    uint32_t list[DRAFT_BEAM];
    uint64_t record = facet_record(beam->draft, number);
    uint32_t surface = facet_surface(beam->draft, record);
    if (meet_plane(&m, beam, through, middle, record, surface) == 0) {
        return;
    }
    uint32_t n = list_set(list, m.met);
    uint16_t footprint = (uint16_t)facet_footprint(beam->draft, record);
    for (uint32_t k = 0; k < n; k++) {
        uint32_t i = list[k];
        draft_meeting one = {m.t[i], m.u[i], m.v[i], number, footprint, (m.rate[i] > 0) != surface_down(surface)};
        draft_meeting_insert(v->found[i], (uint32_t)v->n[i]++, &one);
    }
}

bool aset_draft_beam_visit(draft_beam *beam, const uint32_t at[3], uint32_t dense, unsigned k) {
    int32_t through[DRAFT_BEAM];
    uint32_t list[DRAFT_BEAM], first, end;
    voxel_meetings v;
    const aset_real low[3] = {(aset_real)(int32_t)(at[0] * 16 + k % 4 * 4), (aset_real)(int32_t)(at[1] * 16 + k / 4 % 4 * 4),
                              (aset_real)(int32_t)(at[2] * 16 + k / 16 * 4)};
    int32_t n_through = come_through(through, beam, low);
    if (n_through == 0) {
        return false;
    }
    const aset_real middle[3] = {low[0] + 2, low[1] + 2, low[2] + 2};
    beam->n_visited += (uint64_t)n_through;
    memset(v.n, 0, sizeof v.n);
    draft_find_facets(beam->draft, dense, bits_count(draft_marks(beam->draft, dense) & ((UINT64_C(1) << k) - 1)), &first, &end);
    for (uint32_t f = first; f < end; f++) {
        meet_facet(&v, beam, through, middle, f);
    }
    uint32_t n = list_set(list, v.n);
    for (uint32_t j = 0; j < n; j++) {
        uint32_t i = list[j];
        beam->n_left -= aset_draft_cover_add(&beam->cover[i], v.found[i], (uint32_t)v.n[i]);
        beam->left[i] = beam->cover[i].left;
        beam->end[i] = draft_cover_end(&beam->cover[i]);
    }
    return beam->n_left == 0;
}

#endif
