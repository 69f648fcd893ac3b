/*
 * load.h - readers: bytes in, entities out. Their own archive, libaset_load.a; fixed buffers, no malloc, no stdio.
 *
 * aset_load_nff reads scenes: view, lights, materials, objects. aset_load_stl, aset_load_ply and aset_load_obj read models:
 * they emit materials and triangles and nothing else, and the same model in each format gives the same triangles in the
 * same order.
 */
#ifndef ASET_LOAD_H
#define ASET_LOAD_H

#include "aset/scene.h"

ASET_HEADER_BEGIN

/* Names that carry the layout's switches: see config.h. */

/*
 * The caller's way to more bytes: writes at most size bytes into buffer and returns how many (short reads are fine), 0 at
 * the end of the input, below 0 on failure.
 */
typedef ptrdiff_t (*aset_read)(void *context, void *buffer, size_t size);

/* Bytes that n vertices take: always a point, and where they are used a normal and (PLY only) a colour of each, 0 or 1. */
#define ASET_BYTES_VERTICES(n, with_normals, with_colours)                                                                  \
    ((size_t)(n)*3u * (1u + ((with_normals) ? 1u : 0u) + ((with_colours) ? 1u : 0u)) * sizeof(aset_real))

/* The least block that can serve as a window over a spill file. */
#define ASET_BYTES_WINDOW 1024u

/*
 * Where the readers of OBJ and PLY keep vertices, the one thing in a model that needs memory in proportion to it: a face
 * may name any vertex of the file. As long as they fit in block they stay there, exactly as many as ASET_BYTES_VERTICES
 * says. When they do not, and write and read are given, all vertices move to the spill file behind these callbacks, and the
 * block (ASET_BYTES_WINDOW bytes or more) becomes a window: pages of at most 4 kB, of which the least recently used goes.
 * So memory is bounded by the block, whatever the file announces or holds; what grows is the spill file, to
 * ASET_BYTES_VERTICES and a page (with smooth to twice the larger of an OBJ's points and normals), and only by vertices
 * that were read. It is private to one call, and its content before does not matter. Faces that jump about in a small
 * window are slow, not wrong: at worst each corner costs one read of a page.
 *
 * Without the callbacks more vertices than the block holds are ASET_ERR_NOMEM, and the report's token says how many it
 * holds.
 */
typedef struct aset_vertex_store {
    void *block; /* any alignment */
    size_t size; /* bytes of block */
    /* Both NULL, or both given: put and get size bytes at offset; false on failure. read asks only for what was written. */
    bool (*write)(void *context, uint64_t offset, const void *bytes, size_t size);
    bool (*read)(void *context, uint64_t offset, void *bytes, size_t size);
    void *context;
} aset_vertex_store;

/*
 * The caller's way to the material libraries that an OBJ names. open is given the name as the file has it, without blanks
 * around; if there is such a library it fills read and stream (read's context) and returns true, else it returns false, and
 * that is no error. Every stream that was opened is closed, one before the next is opened. A library may be opened many
 * times.
 */
typedef struct aset_library {
    bool (*open)(void *context, const char *name, aset_read *read, void **stream);
    void (*close)(void *context, void *stream); /* may be NULL */
    void *context;
} aset_library;

/* Bytes of memory for n named materials of an OBJ. */
#define ASET_BYTES_MATERIALS(n) ((size_t)(n) * sizeof(aset_named_material))

/* Private: one material of a library. The name is kept as 64 bits made of it (FNV-1a). */
typedef struct aset_named_material {
    uint64_t name;
    uint32_t used; /* when it was used last; 0: the entry is free */
    uint32_t state;
    aset_material material;
} aset_named_material;

/* All zero, or a NULL for the whole struct, gives the defaults. */
typedef struct aset_load_options {
    bool one_sided_opaque; /* NFF only: materials with T = 0 are one-sided (the SPD testing procedure) */
    /* Models: emit patches where the file has vertex normals (OBJ vn, PLY nx ny nz), else they are ignored. */
    bool smooth;
    uint64_t size; /* bytes of the whole input, 0 if that is not known: STL and PLY check their counts against it */
    /* Models: the surface of everything that the file gives none; NULL: fill 0.8 0.8 0.8, diffuse 1, no more, two-sided. */
    const aset_material *material;
    const aset_vertex_store *vertices; /* OBJ and PLY; NULL: room for none */
    const aset_library *library;       /* OBJ; NULL: there are no libraries, and usemtl changes nothing */
    /*
     * OBJ: memory for the named materials that are kept, ASET_BYTES_MATERIALS, aligned for one; NULL: 8 are kept. When it
     * is full the least recently used goes, and the libraries are read again for one that is not there: too few cost time,
     * no more.
     */
    aset_named_material *materials;
    uint32_t n_materials;
} aset_load_options;

/* What a reader says beside its status. On an error: where (the first byte of the token it could not take) and why. */
typedef struct aset_load_report {
    uint64_t offset;      /* bytes from the start of the input */
    uint32_t line;        /* counted from 1; 0 within binary data, where there are no lines */
    const char *what;     /* what is wrong, static text; NULL without an error */
    const char *expected; /* what was expected there, static text; NULL if there is nothing to add */
    char token[32];       /* the token in question, cut if longer, unprintable bytes as '?'; "" if none */
    char library[64];     /* the place is in the material library of this name (cut if longer); "": in the input itself */
    /* Models, counted up to the end or the error: */
    uint64_t triangles; /* given to the sink and taken */
    /*
     * Triangles left out because a coordinate is not finite or beyond what models may have (10^15, 10^150 in double) or
     * because the sink refused them with ASET_ERR_GEOMETRY, and faces of fewer than 3 points. No sink of the library
     * refuses a triangle without area or one that came before: they are no faults, and no ray hits the former.
     */
    uint64_t skipped;
    uint64_t vertices;          /* read */
    uint64_t unknown_materials; /* OBJ: usemtl lines whose material is in no library; options->material stands in */
} aset_load_report;

/*
 * Reads a scene in the Neutral File Format (Haines 1987) and emits its entities into sink. Tokens decide, not lines. Takes
 * v, b, l, f, c, s, p, pp and comments; a view's hither is read and not used (it serves hidden-surface programs); objects
 * need a material and a view before them, and a file without a view is an error. options may be NULL for all defaults.
 *
 * ASET_ERR_SYNTAX: not NFF (letters for numbers, a number that is not finite or outside the range of aset_real, counts that
 * are not positive whole numbers, a file that ends within an entity, an empty one). ASET_ERR_GEOMETRY: a view without a
 * direction or with up along it. ASET_ERR_UNSUPPORTED: an object or effect that is switched off. Others: the sink's, at the
 * entity that it refused. ASET_ERR_READ: the callback failed. report (not NULL) tells the place.
 */
aset_status aset_load_nff(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report);

/*
 * The readers of models have this in common. They emit a material, then triangles; a polygon becomes a fan around its first
 * point, so every polygon that the sink gets is a triangle (concave ones are not what they were). Their memory is some kilobytes
 * of stack (PLY 10, OBJ and STL 6) and what the options lend. Time is proportional to the input, and for OBJ to its libraries,
 * once for each name that is not kept. Colours are taken as linear.
 *
 * ASET_ERR_SYNTAX: not in the format, cut off, a count or an index that does not fit the rest, or "no facet in it": a model that
 * gives the sink no triangle. ASET_ERR_NOMEM: more vertices than the store holds. ASET_ERR_LIMIT: more than can be counted or
 * kept, as report->what says. ASET_ERR_UNSUPPORTED: a part of the format that is not read, or a feature that is switched off.
 * ASET_ERR_READ: a callback failed. Others: the sink's, except ASET_ERR_GEOMETRY, which only leaves a triangle out.
 * What was emitted before an error stays in the sink.
 */

/*
 * Stereolithography, binary and text. Binary is recognised by its size where options->size is known: 84 bytes and 50 for each
 * of the n triangles announced at byte 80; the word "solid" is no sign, as many binary files begin with it. Any other size is
 * text if the file begins with "solid" and no control byte stands from byte 80 on among the first 4 kB, and else a binary file
 * of a wrong size, an error. With the size unknown the same look decides between text and binary.
 *
 * Normals are ignored (the order of the points tells the front), and so are the attribute bytes: the colours that VisCAM and
 * Materialise keep there, in two conventions that contradict each other, are left out. Text is taken in upper or lower case,
 * with names or without, several solids in a file, more than three points in a loop. Needs no vertex store.
 */
aset_status aset_load_stl(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report);

/*
 * The Polygon File Format (Turk 1994), text and binary of both byte orders: properties of any type and order, x y z of the
 * element vertex and the list vertex_indices (or vertex_index) of face; vertices before faces. Other elements and
 * properties, lists too, are passed over. Triangle strips are ASET_ERR_UNSUPPORTED; a cloud of points has "no facet in it".
 * At most 16 elements and 48 properties, where neighbouring numbers that are not used count as one (else ASET_ERR_LIMIT).
 * Bytes behind the last element are an error, except blanks, and zeros in binary files.
 *
 * Colours (red green blue, also r g b and diffuse_red ...; whole numbers are divided by their type's largest, reals taken
 * as they are, alpha ignored) become the fill of options->material: the face's own if it has one, and it may then have 64
 * points at most (else ASET_ERR_LIMIT), or the mean of the triangle's three corners.
 */
aset_status aset_load_ply(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report);

/*
 * Wavefront OBJ: v, f (v, v/vt, v//vn, v/vt/vn; negative indices count back from the last one read), lines joined by a
 * backslash at their end, and with smooth vn; a normal that is not there is none. usemtl takes its material from the libraries
 * named by mtllib before the next face, the first of that name; everything else (o g s vt l p, curves, a fourth number of v ...)
 * is passed over line by line. A # begins a comment, but within usemtl's, mtllib's and newmtl's names only where a blank or
 * the line's end follows: "Material #25" is a name.
 *
 * Of a material: Kd is the fill, and diffuse becomes 1; Ks gives specular by its largest component and Ns shine; d gives
 * transmittance 1 - d, or else Tr gives transmittance; Ni is the refraction index. What is missing comes from
 * options->material; numbers below 0 are taken as 0, d and Tr above 1 as 1. illum below 3 (no reflection; many programs write
 * 2 and a Ks of 0.5 for whatever is matt) makes specular 0, which would be a mirror here. Maps and the other words are ignored.
 * ASET_ERR_LIMIT: more than 500 bytes of names of libraries, one more for each; a library's or a material's name of more than 255.
 */
aset_status aset_load_obj(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report);

ASET_HEADER_END
#endif
