/*
 * emit.h - what the procedural scenes share: the list of scenes, and doubles in, entities out.
 *
 * A scene computes in double whatever aset_real is, and the helpers round each number once, when it is emitted: so the
 * float and the double build make the same scene to within one rounding. Each helper returns the sink's status,
 * ASET_ERR_ARGUMENT where the sink lacks the function, or ASET_ERR_UNSUPPORTED where the library was compiled without
 * what the entity needs.
 */
#ifndef ASET_PROCEDURAL_EMIT_H
#define ASET_PROCEDURAL_EMIT_H

#include "aset/procedural.h"

/*
 * The one list of scenes, in the order in which aset_procedural_at gives them; it makes the declarations, the limits and
 * the table: (function, name, default size, largest size, what it is and what size means).
 */
#define ASET_PROCEDURAL_SCENES(X)                                                                                       \
    X(balls, "balls", 4, 7, "sphereflake: spheres on spheres above a floor; size: levels below the first sphere")       \
    X(gears, "gears", 4, 16, "a cube of meshing gears, some of them glass; size: gears along each edge")                \
    X(mount, "mount", 6, 11, "a fractal mountain below four glass spheres; size: halvings of its square")               \
    X(rings, "rings", 7, 30, "a pyramid of interlocked rings before a wall; size: layers")                              \
    X(teapot, "teapot", 6, 64, "a teapot on a checkerboard; size: cells along each edge of a patch")                    \
    X(tetra, "tetra", 6, 12, "a tetrahedron of tetrahedra (Sierpinski); size: levels")                                  \
    X(tree, "tree", 11, 16, "a forking tree of cones and spheres; size: forks above the trunk")                         \
    X(snow, "snow", 1, 1, "a winter night, 813 objects: pond, snowman, firs, crystals; one size")                         \
    X(tetra_moon, "tetra-moon", 5, 10, "tetrahedra of ruby glass before a moon; size: levels")                          \
    X(skull, "skull", 1, 1, "a skull and crossed bones on a dark mirror; one size")

#define ASET_PROCEDURAL_DECLARE(id, name, default_size, largest_size, text)                                             \
    aset_status aset_procedural_##id(const aset_sink *sink, uint32_t size);
ASET_PROCEDURAL_SCENES(ASET_PROCEDURAL_DECLARE)
#undef ASET_PROCEDURAL_DECLARE

/* default_size_balls, largest_size_balls, ... */
enum {
#define ASET_PROCEDURAL_LIMITS(id, name, default_size, largest_size, text)                                              \
    default_size_##id = (default_size), largest_size_##id = (largest_size),
    ASET_PROCEDURAL_SCENES(ASET_PROCEDURAL_LIMITS)
#undef ASET_PROCEDURAL_LIMITS
    emit_limits_end
};

/* Puts the default in the place of 0. ASET_ERR_ARGUMENT above the largest. Every scene opens with EMIT_SIZE. */
aset_status aset_emit_size(uint32_t *size, uint32_t default_size, uint32_t largest_size);
#define EMIT_SIZE(id, size) aset_emit_size((size), default_size_##id, largest_size_##id)

/* The whole of a scene that the library was compiled without the entities for. */
#define EMIT_UNSUPPORTED(id)                                                                                            \
    aset_status aset_procedural_##id(const aset_sink *sink, uint32_t size) {                                            \
        (void)sink, (void)size;                                                                                         \
        return ASET_ERR_UNSUPPORTED;                                                                                    \
    }

#define EMIT_PI 3.14159265358979323846
#define EMIT_RAD(degrees) ((degrees) * (EMIT_PI / 180.0))

typedef struct emit_point {
    double x, y, z;
} emit_point;

/* A material in the order of NFF's f. Always two-sided. */
typedef struct emit_surface {
    double r, g, b, diffuse, specular, shine, transmittance, refraction_index;
} emit_surface;

/*
 * Phong exponents that the SPD gives by the angle h at which a highlight has half its strength: ln(0.5) / ln(cos h). Its
 * 100000 stands for h = 0, where there is no exponent: no highlight is meant.
 */
#define EMIT_SHINE_37 3.0827007755568205
#define EMIT_SHINE_30 4.81884167930642
#define EMIT_SHINE_6_7 101.1483608391674
#define EMIT_DULL 100000.0

aset_status aset_emit_background(const aset_sink *sink, double r, double g, double b);

/* Perspective; the full field of view; a square picture. */
aset_status aset_emit_view(const aset_sink *sink, const emit_point *from, const emit_point *at, const emit_point *up,
                           double angle_deg, uint32_t size_px);

/* A point light without a colour of its own. */
aset_status aset_emit_light(const aset_sink *sink, const emit_point *position);

aset_status aset_emit_material(const aset_sink *sink, const emit_surface *surface);

/* n_points points, counter-clockwise seen from the front; normals NULL, or as many and then it is a patch. */
aset_status aset_emit_polygon(const aset_sink *sink, const emit_point *points, const emit_point *normals,
                              uint32_t n_points);

aset_status aset_emit_sphere(const aset_sink *sink, const emit_point *centre, double radius);

aset_status aset_emit_cone(const aset_sink *sink, const emit_point *base, double base_radius, const emit_point *apex,
                           double apex_radius);

/* What opens each SPD scene: the sky's background, the view (45 degrees, 512 x 512) and the lights. */
typedef struct emit_setting {
    emit_point from, at, up;
    const emit_point *lights;
    uint32_t n_lights;
} emit_setting;

aset_status aset_emit_setting(const aset_sink *sink, const emit_setting *setting);

/*
 * The 4^depth triangles of Sierpinski's tetrahedron about centre, with corners at centre + half_edge * (+-1, +-1, +-1);
 * depth 1 or more (1: one tetrahedron), and the bound of the recursion. For tetra and tetra-moon.
 */
aset_status aset_emit_tetrahedra(const aset_sink *sink, uint32_t depth, const emit_point *centre, double half_edge);

#endif
