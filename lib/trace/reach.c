/*
 * reach.c - the draft's marked voxels projected onto tiles before each light (outlook.h).
 *
 * A tile keeps a distance that no point of a voxel whose outline touches it falls short of: by the voxel's ball, or where the
 * light is a direction by its extent. A shadow ray starts beside the point that it lights and runs parallel to the line from
 * there: so boxes are grown by that much, and the point is looked up.
 */
#include "trace/reach.h"

#include "approx/facet.h"
#include "base/whole.h"

#if ASET_WITH_DRAFTS

#define OFF_GROWN R(0.5)  /* in columns: what boxes are grown by, */
#define OFF_MOST R(0.45)  /* and how far beside its point a ray may start */
#define TILE_GROWN R(0.001)

/* A light's map looks at the middle of the cells' box and is as wide as that. */
static void look_from(aset_outlook *o, const aset_light *light, const outlook_cells *c) {
    o->parallel = light->directional;
    o->from = o->parallel ? vec_along(c->middle, 2 * c->diagonal, light->position) : light->position;
    o->forward = aset_vec_unit(vec_sub(c->middle, o->from));
    aset_vec3 aside = real_abs(o->forward.x) < R(0.6) ? vec(1, 0, 0) : vec(0, 1, 0);
    o->across = aset_vec_unit(vec_cross(o->forward, aside));
    o->down = vec_cross(o->forward, o->across);
    aset_real depth = 1;
    if (!o->parallel) { /* of the box's nearest plane; not above 0: then it cannot be seen */
        depth = vec_dot(vec_sub(c->middle, o->from), o->forward) - outlook_extent(c->half, o->forward);
    }
    o->across = vec_scale(o->across, depth / outlook_extent(c->half, o->across));
    o->down = vec_scale(o->down, depth / outlook_extent(c->half, o->down));
    aset_outlook_set_voxels(o, c, OFF_GROWN * c->column);
}

static uint32_t tile_at(const aset_reach_map *map, aset_real x) {
    aset_real last = (aset_real)(int32_t)(map->tiles - 1), half = (aset_real)(int32_t)map->tiles / 2;
    return (uint32_t)(int32_t)real_min(real_max((x + 1) * half, 0), last);
}

static void add_voxel(aset_reach_map *map, aset_vec3 middle) {
    const aset_outlook *o = &map->outlook;
    aset_vec3 way = vec_sub(middle, o->from);
    outlook_rectangle r = outlook_of(o, way, 1);
    aset_real more = 2 * TILE_GROWN / (aset_real)(int32_t)map->tiles;
    uint32_t left = tile_at(map, r.left - more), right = tile_at(map, r.right + more), bottom = tile_at(map, r.bottom + more);
    aset_real near = o->parallel ? vec_dot(way, o->forward) - o->half_forward : aset_vec_length(way) - o->ball;
    for (uint32_t row = tile_at(map, r.top - more); row <= bottom; row++) {
        aset_real *tiles = map->near + (size_t)row * map->tiles;
        for (uint32_t column = left; column <= right; column++) {
            tiles[column] = real_min(tiles[column], near);
        }
    }
}

static void fill(aset_reach_map *map, const aset_draft *draft, const outlook_cells *cells) {
    const uint32_t *n = draft->blocks;
    uint32_t dense = 0;
    for (size_t i = 0; i < (size_t)map->tiles * map->tiles; i++) {
        map->near[i] = REAL_INFINITY;
    }
    for (uint32_t i = 0; i < n[0] * n[1] * n[2]; i++) {
        if (!draft_has_block(draft, i)) {
            continue;
        }
        for (uint64_t marks = draft_marks(draft, dense++); marks != 0; marks &= marks - 1) {
            unsigned k = bits_lowest(marks);
            add_voxel(map, outlook_middle(cells, i % n[0] * 4 + k % 4, i / n[0] % n[1] * 4 + k / 4 % 4, i / n[0] / n[1] * 4 + k / 16));
        }
    }
}

static aset_real last_before(const aset_reach *reach, uint32_t light, aset_vec3 point, aset_real off, const light_ray *towards) {
    const aset_reach_map *map = reach->lights + light;
    const aset_outlook *o = &map->outlook;
    if (map->tiles == 0 || !(off <= OFF_MOST * reach->draft->column)) {
        return REAL_INFINITY;
    }
    aset_vec3 way = vec_sub(point, o->from);
    aset_real depth = vec_dot(way, o->forward), per_depth = o->parallel ? 1 : 1 / depth;
    if (!o->parallel && !(depth > 0)) {
        return REAL_INFINITY;
    }
    aset_real x = vec_dot(way, o->across) * per_depth, y = vec_dot(way, o->down) * per_depth;
    if (real_abs(x) > 1 || real_abs(y) > 1) { /* beside all voxels */
        return 0;
    }
    return (o->parallel ? depth : towards->distance) - map->near[tile_at(map, y) * map->tiles + tile_at(map, x)];
}

#if DRAFT_SHADES_BEAMS

/* The same for points side by side, which may be any numbers. In steps, for what depends on branches is no loop for wide registers. */
static void last_each(aset_real *restrict last, const aset_reach *reach, uint32_t light, const reach_points *restrict p) {
    const aset_reach_map *map = reach->lights + light;
    const aset_outlook *o = &map->outlook;
    aset_vec3 from = o->from, forward = o->forward, across = o->across, down = o->down;
    aset_real most = OFF_MOST * reach->draft->column, half = (aset_real)(int32_t)map->tiles / 2, end = 2 * half - 1;
    if (map->tiles == 0) {
        return;
    }
    aset_real depth_counts = o->parallel ? 0 : 1, else_one = 1 - depth_counts, least = o->parallel ? -REAL_MAX : 0;
    aset_real x[DRAFT_BEAM], y[DRAFT_BEAM], depth[DRAFT_BEAM];
    int32_t known[DRAFT_BEAM], column[DRAFT_BEAM], row[DRAFT_BEAM];
    EACH_RAY(i) {
        aset_real way_x = p->point[0][i] - from.x, way_y = p->point[1][i] - from.y, way_z = p->point[2][i] - from.z;
        aset_real forth = way_x * forward.x + way_y * forward.y + way_z * forward.z;
        aset_real per_depth = 1 / (depth_counts * forth + else_one);
        x[i] = (way_x * across.x + way_y * across.y + way_z * across.z) * per_depth;
        y[i] = (way_x * down.x + way_y * down.y + way_z * down.z) * per_depth;
        depth[i] = forth;
        known[i] = (p->off[i] <= most) & (forth > least);
    }
    EACH_RAY(i) {
        aset_real at_x = real_max((x[i] + 1) * half, 0), at_y = real_max((y[i] + 1) * half, 0);
        x[i] = real_min(at_x, end);
        y[i] = real_min(at_y, end);
    }
    EACH_RAY(i) {
        column[i] = (int32_t)x[i];
        row[i] = (int32_t)y[i];
    }
    EACH_RAY(i) {
        if (known[i]) { /* beside all voxels nothing is ahead, and any t will do */
            aset_real start = o->parallel ? depth[i] : p->distance[i];
            last[i] = start - map->near[(uint32_t)row[i] * map->tiles + (uint32_t)column[i]];
        }
    }
}

static const struct aset_reach_calls calls = {last_before, last_each};

#else

static const struct aset_reach_calls calls = {last_before, NULL};

#endif

aset_status aset_reach_init(aset_reach *reach, const aset_draft *draft, uint32_t tiles, aset_arena *arena) {
    if (reach == NULL || draft == NULL || arena == NULL || tiles < 1 || tiles > ASET_REACH_TILES_MAX) {
        return ASET_ERR_ARGUMENT;
    }
    uint32_t n_lights = draft->stage.counts.lights;
    uint64_t bytes = ASET_ROUND_64((uint64_t)n_lights * sizeof(aset_reach_map)) +
                     n_lights * ASET_ROUND_64((uint64_t)tiles * tiles * sizeof(aset_real)); /* ASET_BYTES_REACH, whatever a size_t holds */
    unsigned char *at = aset_arena_alloc(arena, whole_bytes(bytes), ASET_CATEGORY_SCRATCH);
    if (at == NULL && n_lights > 0) {
        return ASET_ERR_NOMEM;
    }
    const outlook_cells cells = aset_outlook_cells_of(draft);
    reach->calls = &calls;
    reach->draft = draft;
    reach->lights = (aset_reach_map *)(void *)at;
    reach->n_lights = n_lights;
    at = n_lights > 0 ? at + ASET_ROUND((size_t)n_lights * sizeof(aset_reach_map)) : NULL;
    for (uint32_t i = 0; i < n_lights; i++, at += ASET_ROUND((size_t)tiles * tiles * sizeof(aset_real))) {
        aset_reach_map *map = reach->lights + i;
        look_from(&map->outlook, draft->stage.lights + i, &cells);
        map->position = draft->stage.lights[i].position;
        map->directional = draft->stage.lights[i].directional;
        map->near = (aset_real *)(void *)at;
        map->tiles = aset_outlook_can_see(&map->outlook, &cells) ? tiles : 0;
        if (map->tiles > 0) {
            fill(map, draft, &cells);
        }
    }
    return ASET_OK;
}

#endif
