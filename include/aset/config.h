/*
 * config.h - what a build of libaset contains.
 *
 * Every switch may be given on the compiler's command line; a switch at 0 removes the feature's code and its bytes in every
 * struct ("model only what a scene requires"). The library and every program that includes these headers must agree: the
 * values are part of the names of the functions that take an affected struct, so a disagreement does not link.
 */
#ifndef ASET_CONFIG_H
#define ASET_CONFIG_H

#define ASET_VERSION_MAJOR 0
#define ASET_VERSION_MINOR 1
#define ASET_VERSION_PATCH 0
#define ASET_VERSION "0.1.0"

/*
 * The number of the binary interface: it goes up by one when a program compiled with the last release's headers would not
 * work with this library, and the shared library carries it in its name (libaset.so.0).
 */
#define ASET_ABI 0

/* Bits of a real number: 32 (float, the default and the one all published byte counts use) or 64 (double). */
#ifndef ASET_REAL_BITS
#define ASET_REAL_BITS 32
#endif
/* Polygons of any number of vertices, concave too. */
#ifndef ASET_WITH_POLYGONS
#define ASET_WITH_POLYGONS 1
#endif
/* Polygons with a normal at every vertex; needs polygons. */
#ifndef ASET_WITH_PATCHES
#define ASET_WITH_PATCHES 1
#endif
#ifndef ASET_WITH_SPHERES
#define ASET_WITH_SPHERES 1
#endif
/* Cones and cylinders with open ends. */
#ifndef ASET_WITH_CONES
#define ASET_WITH_CONES 1
#endif
/* Mirror reflection. Without it a material's specular part is its highlight alone. */
#ifndef ASET_WITH_REFLECTION
#define ASET_WITH_REFLECTION 1
#endif
/* Transmitted rays (Snell, total internal reflection). Without it a transmitting material is refused, not drawn opaque. */
#ifndef ASET_WITH_REFRACTION
#define ASET_WITH_REFRACTION 1
#endif
/* Cell summaries and the rays that stop at them (ASET). Without it the library is exact only. */
#ifndef ASET_WITH_APPROXIMATION
#define ASET_WITH_APPROXIMATION 1
#endif
/* Drafts: models baked into facets, and the rays that meet these; needs the approximation. */
#ifndef ASET_WITH_DRAFTS
#define ASET_WITH_DRAFTS ASET_WITH_APPROXIMATION
#endif

/*
 * 1: walks among blocks of voxels are written out for each space and kind of ray; 0, as where the compiler is to save code (-Os): all
 * take one, 2 to 3 kB less for 3 % more instructions a ray, or 29 to 60 % more if it is approximate. Pictures and counts
 * are the same; a program and its library need not agree on it.
 */
#ifndef ASET_FUSED
#ifdef __OPTIMIZE_SIZE__
#define ASET_FUSED 0
#else
#define ASET_FUSED 1
#endif
#endif

/*
 * 1: what beams do most is compiled a second time for AVX2, and taken where the processor has it: a tenth less time a draft, 7.5 kB more
 * code. So it is where a compiler for x86-64 can do that (gcc from 10 on, clang), optimizes, is not to save code (-Os), and
 * may not take AVX2 anyway (-march=x86-64-v3). Pictures and counts are the same; a program and its library need not agree on it.
 */
#ifndef ASET_WIDE
#define ASET_WIDE 0
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__OPTIMIZE_SIZE__) && !defined(__AVX2__) && defined(__has_builtin)
#if __has_builtin(__builtin_cpu_supports) && !defined(_WIN32) && !defined(__CYGWIN__) && __STDC_HOSTED__
#undef ASET_WIDE
#define ASET_WIDE 1
#endif
#endif
#endif

/*
 * 1: a build that looks for faults (make check-long): the arena's block is filled with garbage at the start, and what is given back
 * again. ASET_LARGE_MAX, ASET_RECENT and ASET_READER_BUFFER may be small in it.
 */
#ifndef ASET_HOSTILE
#define ASET_HOSTILE 0
#endif

#if ASET_REAL_BITS != 32 && ASET_REAL_BITS != 64
#error "ASET_REAL_BITS is 32 (float) or 64 (double)"
#endif
#if ASET_WITH_PATCHES && !ASET_WITH_POLYGONS
#error "ASET_WITH_PATCHES needs ASET_WITH_POLYGONS: a patch is a polygon with normals"
#endif
#if ASET_WITH_DRAFTS && !ASET_WITH_APPROXIMATION
#error "ASET_WITH_DRAFTS needs ASET_WITH_APPROXIMATION: who may take a draft is said by the same fields"
#endif
/* With no kind of object at all the library draws drafts that keep none exact, and nothing else. */
#define ASET_WITH_OBJECTS (ASET_WITH_POLYGONS || ASET_WITH_SPHERES || ASET_WITH_CONES)
#if !ASET_WITH_OBJECTS && !ASET_WITH_DRAFTS
#error "switch on at least one kind of object, ASET_WITH_POLYGONS, ASET_WITH_SPHERES or ASET_WITH_CONES, or ASET_WITH_DRAFTS"
#endif

/*
 * Around the declarations of each public header: C linkage, and visible in a shared library, where everything else is hidden
 * (-fvisibility=hidden).
 */
#if defined(__GNUC__) && !defined(_WIN32)
#define ASET_VISIBLE_BEGIN _Pragma("GCC visibility push(default)")
#define ASET_VISIBLE_END _Pragma("GCC visibility pop")
#else
#define ASET_VISIBLE_BEGIN
#define ASET_VISIBLE_END
#endif
#ifdef __cplusplus
#define ASET_HEADER_BEGIN ASET_VISIBLE_BEGIN extern "C" {
#define ASET_HEADER_END } ASET_VISIBLE_END
#else
#define ASET_HEADER_BEGIN ASET_VISIBLE_BEGIN
#define ASET_HEADER_END ASET_VISIBLE_END
#endif

/*
 * Names that carry the switches. A program compiled with other values asks the linker for a function that the library does
 * not have, for example aset_scene_init__32_01111111 instead of aset_scene_init__32_11111111.
 */
#define ASET_LAYOUT_PASTE(name, bits, a, b, c, d, e, f, g, h) name##__##bits##_##a##b##c##d##e##f##g##h
#define ASET_LAYOUT_EXPAND(name, bits, a, b, c, d, e, f, g, h) ASET_LAYOUT_PASTE(name, bits, a, b, c, d, e, f, g, h)
#define ASET_LAYOUT(name)                                                                                              \
    ASET_LAYOUT_EXPAND(name, ASET_REAL_BITS, ASET_WITH_POLYGONS, ASET_WITH_PATCHES, ASET_WITH_SPHERES,                 \
                       ASET_WITH_CONES, ASET_WITH_REFLECTION, ASET_WITH_REFRACTION, ASET_WITH_APPROXIMATION, \
                       ASET_WITH_DRAFTS)

#define aset_arena_init ASET_LAYOUT(aset_arena_init)
#define aset_scene_init ASET_LAYOUT(aset_scene_init)
#define aset_scene_sink ASET_LAYOUT(aset_scene_sink)
#define aset_counter_sink ASET_LAYOUT(aset_counter_sink)
#define aset_scene_emit ASET_LAYOUT(aset_scene_emit)
#define aset_sink_polygon ASET_LAYOUT(aset_sink_polygon)
#define aset_space_build ASET_LAYOUT(aset_space_build)
#define aset_space_measure ASET_LAYOUT(aset_space_measure)
#define aset_summary_measure ASET_LAYOUT(aset_summary_measure)
#define aset_summary_build ASET_LAYOUT(aset_summary_build)
#define aset_flat_init ASET_LAYOUT(aset_flat_init)
#define aset_flat_sink ASET_LAYOUT(aset_flat_sink)
#define aset_flat_finish ASET_LAYOUT(aset_flat_finish)
#define aset_baker_init ASET_LAYOUT(aset_baker_init)
#define aset_baker_sink ASET_LAYOUT(aset_baker_sink)
#define aset_baker_abandon ASET_LAYOUT(aset_baker_abandon)
#define aset_baker_finish ASET_LAYOUT(aset_baker_finish)
#define aset_draft_open ASET_LAYOUT(aset_draft_open)
#define aset_draft_texture ASET_LAYOUT(aset_draft_texture)
#define aset_closest_hit ASET_LAYOUT(aset_closest_hit)
#define aset_any_hit ASET_LAYOUT(aset_any_hit)
#define aset_scratch_init ASET_LAYOUT(aset_scratch_init)
#define aset_ray_colour ASET_LAYOUT(aset_ray_colour)
#define aset_render_rows ASET_LAYOUT(aset_render_rows)
#define aset_report_text ASET_LAYOUT(aset_report_text)
#define aset_report_json ASET_LAYOUT(aset_report_json)
#define aset_stage_material ASET_LAYOUT(aset_stage_material)
#define aset_stage_emit ASET_LAYOUT(aset_stage_emit)
#define aset_load_nff ASET_LAYOUT(aset_load_nff)
#define aset_load_stl ASET_LAYOUT(aset_load_stl)
#define aset_load_ply ASET_LAYOUT(aset_load_ply)
#define aset_load_obj ASET_LAYOUT(aset_load_obj)
#define aset_procedural_find ASET_LAYOUT(aset_procedural_find)

#endif
