/*
 * fuzz_scene.c - garbage geometry through the scene builder, every method and the tracer. First three bytes: the arena of
 * the spaces, divisions, where rays come from and which method is asked beside brute force; then entities as fuzz.h reads them; rays
 * are made of the last bytes.
 */
#include "draw.h"

#define HEAD 3u
#define RAYS 64u
#define RAYS_FEW 16u /* as many as there are sorts of them */
#define ENTITIES_MAX 40u

typedef struct answer {
    bool found;
    aset_hit hit;
} answer;

static uint32_t next(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static aset_real share(uint32_t *state) {
    return (aset_real)(next(state) % 65u) / 64;
}

static aset_vec3 in_box(const aset_scene *scene, uint32_t *state, aset_real beyond) {
    aset_vec3 p;
    p.x = scene->low.x + (scene->high.x - scene->low.x) * (share(state) * beyond - (beyond - 1) / 2);
    p.y = scene->low.y + (scene->high.y - scene->low.y) * (share(state) * beyond - (beyond - 1) / 2);
    p.z = scene->low.z + (scene->high.z - scene->low.z) * (share(state) * beyond - (beyond - 1) / 2);
    return p;
}

/* Between points on a raster of the scene's box, along axes, or of any bits at all. */
static aset_ray make_ray(const aset_scene *scene, uint32_t number, uint32_t *state, bytes *b) {
    aset_ray ray;
    if (number % 8 == 7) {
        ray.origin = take_vec(b, NUMBERS_BITS);
        ray.direction = take_vec(b, NUMBERS_BITS);
        ray.t_max = number % 16 == 7 ? (aset_real)INFINITY : take_bits(b);
        return ray;
    }
    aset_vec3 to = in_box(scene, state, 1);
    ray.origin = in_box(scene, state, number % 2 == 0 ? 1 : number % 4 == 1 ? 4 : 100);
    ray.direction.x = number % 8 == 2 ? 0 : to.x - ray.origin.x;
    ray.direction.y = number % 8 == 2 || number % 8 == 3 ? 0 : to.y - ray.origin.y;
    ray.direction.z = to.z - ray.origin.z;
    ray.t_max = number % 8 == 6 ? 1 : (aset_real)INFINITY;
    return ray;
}

/* The first ones in most runs. */
static uint32_t n_rays(uint32_t choice) {
    return chosen(choice, 8, 0) ? RAYS : RAYS_FEW;
}

/* Against brute force: the same object at the same t, for every method. */
static void shoot(const aset_tracer *tracer, const aset_ray *rays, uint32_t n, answer *answers, bool is_brute) {
    for (uint32_t i = 0; i < n; i++) {
        answer a;
        bool any = false;
        memset(&a, 0, sizeof a);
        aset_status status = aset_closest_hit(&a.found, &a.hit, tracer, rays + i, false, NULL);
        check_answer(status, rays + i);
        require(aset_any_hit(&any, tracer, rays + i, false, NULL) == status);
        require(any == a.found);
        if (a.found) {
            check_hit(tracer, &a.hit, rays + i);
            require(a.hit.material != NULL);
        }
        if (is_brute) {
            answers[i] = a;
        } else {
            require(a.found == answers[i].found);
            require(!a.found || (a.hit.object == answers[i].hit.object && a.hit.t == answers[i].hit.t));
        }
    }
}

static void check_colours(const aset_tracer *tracer, const aset_ray *rays, uint32_t n, bool tame) {
    aset_arena arena = open_arena(ASET_BYTES_SCRATCH(DRAW_DEPTH));
    aset_scratch scratch;
    require(aset_scratch_init(&scratch, DRAW_DEPTH, &arena) == ASET_OK);
    for (uint32_t i = 0; i < n; i += 9) {
        aset_colour c = {0, 0, 0};
        aset_status status = aset_ray_colour(&c, tracer, rays + i, &scratch, NULL);
        require(status == ASET_OK || status == ASET_ERR_ARGUMENT);
        require(!tame || (c.r >= 0 && c.g >= 0 && c.b >= 0 && isfinite(c.r) && isfinite(c.g) && isfinite(c.b)));
    }
    close_arena(&arena);
}

#if ASET_WITH_APPROXIMATION
/*
 * What the scene was made of, once more: from itself, or as it was given where it is so huge that its tiniest parts have lost bits in
 * it, or all length.
 */
static void give_again(const aset_sink *sink, const aset_scene *scene, bytes given) {
    bool tame;
    if (scene->scale < 1) {
        (void)put_entities(given, sink, ENTITIES_MAX, &tame);
    } else {
        require(aset_scene_emit(sink, scene) == ASET_OK);
    }
}

/* The same from a stream, in as much memory as it asks for and not a byte more: the same answers. */
static void stream(const aset_tracer *whole, const aset_ray *rays, uint32_t n, bytes given) {
    aset_counter counter;
    aset_flat *flat = malloc(sizeof *flat);
    aset_scene stage;
    aset_space space;
    aset_summary summary;
    aset_space_options options;
    aset_status status = ASET_ERR_NOMEM;
    aset_arena arena = open_arena(0);
    aset_sink sink = aset_counter_sink(&counter);
    require(flat != NULL);
    give_again(&sink, whole->scene, given);
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, whole->space->slices.n, sizeof options.divisions);
    options.textures = whole->summary->capacity;
    for (size_t bytes = 0; status == ASET_ERR_NOMEM; bytes += arena.missing) {
        bool again = true;
        close_arena(&arena);
        arena = open_arena(bytes);
        status = aset_flat_init(flat, &arena, &counter, whole->space->method, &options);
        while (status == ASET_OK && again) {
            sink = aset_flat_sink(flat);
            give_again(&sink, whole->scene, given);
            status = aset_flat_pass(flat, &again);
        }
        require(status == ASET_OK || (status == ASET_ERR_NOMEM && arena.missing > 0 && arena.used == 0));
    }
    require(arena.size == flat->least && arena.peak == flat->least);
    require(aset_flat_finish(&stage, &space, &summary, flat) == ASET_OK);
    aset_tracer streamed = *whole;
    streamed.scene = &stage;
    streamed.space = &space;
    streamed.summary = &summary;
    require(summary.merged == whole->summary->merged && summary.n_textures == whole->summary->n_textures);
    for (uint32_t i = 0; i < n; i++) {
        aset_hit a, b;
        bool found_a = false, found_b = false;
        status = aset_closest_hit(&found_a, &a, whole, rays + i, true, NULL);
        require(aset_closest_hit(&found_b, &b, &streamed, rays + i, true, NULL) == status && found_a == found_b);
        require(!found_a || (a.t == b.t && a.cell == b.cell));
        require(!found_a || memcmp(&a.material->fill, &b.material->fill, sizeof a.material->fill) == 0);
    }
    close_arena(&arena);
    free(flat);
}
#endif

static void approximate(aset_tracer *tracer, const aset_space *space, const aset_ray *rays, uint32_t n, bytes given, bool tame,
                        aset_arena *arena) {
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
    aset_mark mark = aset_arena_mark(arena);
    aset_status status = aset_summary_build(&summary, space, 3, arena);
    require(status == ASET_OK || (status == ASET_ERR_NOMEM && arena->missing > 0 && arena->used == mark.used));
    if (status != ASET_OK) {
        return;
    }
    tracer->summary = &summary;
    tracer->approx_kinds = ASET_ALL_KINDS;
    for (uint32_t i = 0; i < n; i += 3) {
        aset_hit hit;
        bool found = false, any = false;
        status = aset_closest_hit(&found, &hit, tracer, rays + i, true, NULL);
        check_answer(status, rays + i);
        require(aset_any_hit(&any, tracer, rays + i, true, NULL) == status && any == found);
        if (found) {
            check_hit(tracer, &hit, rays + i);
            require(hit.object == ASET_NO_OBJECT && hit.material != NULL);
        }
    }
    check_colours(tracer, rays, n, tame);
    if (space->method == &aset_mset || space->method == &aset_grid) {
        stream(tracer, rays, n, given);
    }
    tracer->summary = NULL;
    tracer->approx_kinds = 0;
    aset_arena_release(arena, &mark);
#else
    (void)tracer, (void)space, (void)rays, (void)n, (void)given, (void)tame, (void)arena;
#endif
}

static aset_space_options options_of(uint32_t choice) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    for (int a = 0; a < 3 && choice % 5 != 4; a++) {
        options.divisions[a] = 1 + (choice >> (2 * a)) % 4 * (a == 0 ? 3 : 2);
    }
    options.depth = 1 + choice % 4;
    options.leaf = choice % 3;
    return options;
}

static void trace_all(const aset_scene *scene, const uint8_t *head, bytes given, bytes last, uint32_t choice, bool tame) {
    static const aset_method *const methods[] = {&aset_brute, &aset_set,  &aset_mset,  &aset_grid,
                                                 &aset_octree, &aset_arts, &aset_excell};
    aset_ray rays[RAYS];
    answer answers[RAYS];
    aset_space_options options = options_of(head[1]);
    uint32_t state = head[2], n = n_rays(choice);
    memset(answers, 0, sizeof answers);
    for (uint32_t i = 0; i < RAYS; i++) {
        rays[i] = make_ray(scene, i, &state, &last);
    }
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++) {
        if (m > 0 && !chosen(head[2], 6, (uint32_t)m - 1)) {
            continue;
        }
        aset_arena arena = open_arena(head[0] >= 64 || m == 0 ? 1 << 16 : (size_t)head[0] * 128);
        aset_space space;
        aset_space_size size;
        aset_tracer tracer;
        aset_status measured = aset_space_measure(&size, scene, methods[m], &options, &arena);
        aset_status status = aset_space_build(&space, scene, methods[m], &options, &arena);
        require(status == ASET_OK || ((status == ASET_ERR_NOMEM || status == ASET_ERR_LIMIT || status == ASET_ERR_PRECISION) &&
                                       arena.used == 0));
        require(measured != ASET_OK || status != ASET_OK || options.divisions[0] == 0 || arena.peak <= size.total);
        if (status == ASET_OK) {
            memset(&tracer, 0, sizeof tracer);
            tracer.scene = scene;
            tracer.space = &space;
            tracer.depth = DRAW_DEPTH;
            shoot(&tracer, rays, n, answers, m == 0);
            if (m > 0 || chosen(choice / 8, 8, 0)) {
                approximate(&tracer, &space, rays, n, given, tame, &arena);
            }
            check_colours(&tracer, rays, n, tame);
            if (scene->has_view && chosen(choice / 64, 8, 0)) { /* a picture costs as much as all the rest */
                draw_view(&tracer, &scene->view);
            }
        }
        close_arena(&arena);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    aset_counter counter;
    aset_scene scene;
    bool tame;
    if (size < HEAD + 1) {
        return 0;
    }
    bytes all = {data + HEAD, data + size};
    bytes last = {data + size - (size > 100 ? 100 : size), data + size};
    aset_sink sink = aset_counter_sink(&counter);
    uint32_t counted = put_entities(all, &sink, ENTITIES_MAX, &tame);
    size_t need = ASET_BYTES_SCENE(counter.counts.objects, counter.counts.coordinates, counter.counts.materials,
                                   counter.counts.lights);
    aset_arena arena = open_arena(need);
    require(aset_scene_init(&scene, &arena, &counter.counts) == ASET_OK);
    sink = aset_scene_sink(&scene);
    uint32_t built = put_entities(all, &sink, ENTITIES_MAX, &tame);
    require_same_counts(&scene.counts, &counter.counts);
    require(built == counted);
    if (scene.counts.objects > 0) {
        trace_all(&scene, data, all, last, fuzz_choice(data, size), tame);
    }
    close_arena(&arena);
    return 0;
}
