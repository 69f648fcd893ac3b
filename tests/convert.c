/*
 * convert.c - a model in one format to the same model in another, for tests and for the docs:
 *
 *     convert IN.(obj|stl|ply) OUT stl|stl-ascii|ply-ascii|ply-le|ply-be|obj
 *
 * Triangles only: no colours, no normals of vertices. Points are floats and printed with 9 digits, so every format gives
 * the same ones in the same order; equal points are written once where the format can share them.
 */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "aset/load.h"

#if ASET_WITH_POLYGONS

typedef struct mesh {
    float *points;     /* shared: 3 for each */
    uint32_t *corners; /* 3 for each triangle */
    uint32_t *table;   /* open addressing: number of a point + 1, 0: free */
    uint32_t n_points, points_room, n_corners, corners_room, table_size;
} mesh;

static void *grow(void *old, size_t size) {
    void *block = realloc(old, size);
    if (block == NULL) {
        (void)fprintf(stderr, "convert: out of memory\n");
        exit(1);
    }
    return block;
}

static void free_mesh(mesh *m) {
    free(m->points);
    free(m->corners);
    free(m->table);
}

static uint32_t slot_of(const mesh *m, const float point[3]) {
    uint32_t bits[3], hash = 2166136261u;
    memcpy(bits, point, sizeof bits);
    for (int i = 0; i < 3; i++) {
        hash = (hash ^ bits[i]) * 0x9e3779b1u;
        hash ^= hash >> 15;
    }
    uint32_t at = hash & (m->table_size - 1);
    while (m->table[at] != 0 && memcmp(m->points + 3 * (size_t)(m->table[at] - 1), point, 3 * sizeof(float)) != 0) {
        at = (at + 1) & (m->table_size - 1);
    }
    return at;
}

static void grow_table(mesh *m) {
    m->table_size = m->table_size == 0 ? 1024 : 2 * m->table_size;
    m->table = grow(m->table, m->table_size * sizeof *m->table);
    memset(m->table, 0, m->table_size * sizeof *m->table);
    for (uint32_t i = 0; i < m->n_points; i++) {
        m->table[slot_of(m, m->points + 3 * (size_t)i)] = i + 1;
    }
}

static uint32_t number_of(mesh *m, const float point[3]) {
    if (2 * m->n_points >= m->table_size) {
        grow_table(m);
    }
    const uint32_t at = slot_of(m, point);
    if (m->table[at] == 0) {
        if (m->n_points == m->points_room) {
            m->points_room = 2 * m->points_room + 1024;
            m->points = grow(m->points, 3 * sizeof(float) * m->points_room);
        }
        memcpy(m->points + 3 * (size_t)m->n_points, point, 3 * sizeof(float));
        m->table[at] = ++m->n_points;
    }
    return m->table[at] - 1;
}

/* ---- the sink ---- */

static aset_status take_material(void *context, const aset_material *material) {
    (void)context, (void)material;
    return ASET_OK;
}

static aset_status take_begin(void *context, uint32_t n_points, bool with_normals) {
    (void)context, (void)with_normals;
    return n_points == 3 ? ASET_OK : ASET_ERR_ARGUMENT;
}

static aset_status take_point(void *context, const aset_vec3 *p, const aset_vec3 *normal) {
    mesh *m = context;
    const float point[3] = {(float)p->x, (float)p->y, (float)p->z};
    (void)normal;
    if (m->n_corners == m->corners_room) {
        m->corners_room = 2 * m->corners_room + 1024;
        m->corners = grow(m->corners, sizeof(uint32_t) * m->corners_room);
    }
    m->corners[m->n_corners++] = number_of(m, point);
    return ASET_OK;
}

static aset_status take_end(void *context) {
    (void)context;
    return ASET_OK;
}

/* ---- reading ---- */

static ptrdiff_t read_stream(void *context, void *buffer, size_t size) {
    const size_t n = fread(buffer, 1, size, context);
    return n == 0 && ferror((FILE *)context) ? -1 : (ptrdiff_t)n;
}

static bool ends_with(const char *name, const char *end) {
    const size_t n = strlen(name), k = strlen(end);
    for (size_t i = 0; i < k; i++) {
        if (n < k || tolower((unsigned char)name[n - k + i]) != end[i]) {
            return false;
        }
    }
    return true;
}

static bool read_mesh(mesh *m, const char *path) {
    FILE *stream = fopen(path, "rb");
    if (stream == NULL || fseek(stream, 0, SEEK_END) != 0) {
        perror(path);
        return false;
    }
    const long size = ftell(stream);
    rewind(stream);
    aset_vertex_store store;
    memset(&store, 0, sizeof store);
    store.size = 16 * (size_t)size + 4096; /* no vertex of a file has fewer than 3 bytes */
    store.block = grow(NULL, store.size);
    aset_load_options options;
    memset(&options, 0, sizeof options);
    options.size = (uint64_t)size;
    options.vertices = &store;
    aset_load_report report;
    aset_sink sink;
    memset(&sink, 0, sizeof sink);
    sink.context = m;
    sink.material = take_material;
    sink.polygon_begin = take_begin;
    sink.polygon_point = take_point;
    sink.polygon_end = take_end;
    const aset_status status = ends_with(path, ".obj")   ? aset_load_obj(&sink, read_stream, stream, &options, &report)
                               : ends_with(path, ".ply") ? aset_load_ply(&sink, read_stream, stream, &options, &report)
                                                         : aset_load_stl(&sink, read_stream, stream, &options, &report);
    free(store.block);
    (void)fclose(stream);
    if (status != ASET_OK) {
        (void)fprintf(stderr, "%s:%lu: %s: \"%s\"\n", path, (unsigned long)report.line, report.what, report.token);
    }
    return status == ASET_OK;
}

/* ---- writing ---- */

static void put_bytes(FILE *out, uint32_t x, unsigned bytes, bool high_first) {
    for (unsigned i = 0; i < bytes; i++) {
        (void)putc((int)(x >> 8 * (high_first ? bytes - 1 - i : i) & 0xff), out);
    }
}

static void put_float(FILE *out, float x, bool high_first) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put_bytes(out, bits, 4, high_first);
}

static const float *corner(const mesh *m, uint32_t number) {
    return m->points + 3 * (size_t)m->corners[number];
}

/* The unit normal, or 0 for a triangle without area. */
static void normal_of(const mesh *m, uint32_t first, float normal[3]) {
    double u[3], v[3], n[3], length = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = (double)corner(m, first + 1)[i] - (double)corner(m, first)[i];
        v[i] = (double)corner(m, first + 2)[i] - (double)corner(m, first)[i];
    }
    for (int i = 0; i < 3; i++) {
        n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
        length += n[i] * n[i];
    }
    for (int i = 0; i < 3; i++) {
        normal[i] = length > 0 ? (float)(n[i] / sqrt(length)) : 0;
    }
}

static void write_stl(const mesh *m, FILE *out) {
    (void)fprintf(out, "%-80s", "solid in name only: a binary file that begins like a text");
    put_bytes(out, m->n_corners / 3, 4, false);
    for (uint32_t t = 0; t < m->n_corners; t += 3) {
        float normal[3];
        normal_of(m, t, normal);
        for (int i = 0; i < 3; i++) {
            put_float(out, normal[i], false);
        }
        for (uint32_t i = 0; i < 9; i++) {
            put_float(out, corner(m, t + i / 3)[i % 3], false);
        }
        put_bytes(out, 0, 2, false);
    }
}

static void write_stl_ascii(const mesh *m, FILE *out) {
    (void)fprintf(out, "solid model\n");
    for (uint32_t t = 0; t < m->n_corners; t += 3) {
        float n[3];
        normal_of(m, t, n);
        (void)fprintf(out, "  facet normal %.9g %.9g %.9g\n    outer loop\n", (double)n[0], (double)n[1], (double)n[2]);
        for (uint32_t i = 0; i < 3; i++) {
            const float *p = corner(m, t + i);
            (void)fprintf(out, "      vertex %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
        }
        (void)fprintf(out, "    endloop\n  endfacet\n");
    }
    (void)fprintf(out, "endsolid model\n");
}

static void write_obj(const mesh *m, FILE *out) {
    for (uint32_t i = 0; i < m->n_points; i++) {
        const float *p = m->points + 3 * (size_t)i;
        (void)fprintf(out, "v %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
    }
    for (uint32_t t = 0; t < m->n_corners; t += 3) {
        const uint32_t *c = m->corners + t;
        (void)fprintf(out, "f %lu %lu %lu\n", c[0] + 1ul, c[1] + 1ul, c[2] + 1ul);
    }
}

static void write_ply(const mesh *m, FILE *out, const char *form) {
    const bool text = strcmp(form, "ascii") == 0, high_first = strcmp(form, "binary_big_endian") == 0;
    (void)fprintf(out, "ply\nformat %s 1.0\nelement vertex %lu\nproperty float x\nproperty float y\nproperty float z\n",
                  form, (unsigned long)m->n_points);
    (void)fprintf(out, "element face %lu\nproperty list uchar int vertex_indices\nend_header\n", m->n_corners / 3ul);
    for (uint32_t i = 0; i < m->n_points; i++) {
        const float *p = m->points + 3 * (size_t)i;
        if (text) {
            (void)fprintf(out, "%.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
        } else {
            put_float(out, p[0], high_first), put_float(out, p[1], high_first), put_float(out, p[2], high_first);
        }
    }
    for (uint32_t t = 0; t < m->n_corners; t += 3) {
        const uint32_t *c = m->corners + t;
        if (text) {
            (void)fprintf(out, "3 %lu %lu %lu\n", c[0] + 0ul, c[1] + 0ul, c[2] + 0ul);
        } else {
            put_bytes(out, 3, 1, high_first);
            put_bytes(out, c[0], 4, high_first), put_bytes(out, c[1], 4, high_first), put_bytes(out, c[2], 4, high_first);
        }
    }
}

static bool write_mesh(const mesh *m, FILE *out, const char *format) {
    if (strcmp(format, "stl") == 0) {
        write_stl(m, out);
    } else if (strcmp(format, "stl-ascii") == 0) {
        write_stl_ascii(m, out);
    } else if (strcmp(format, "obj") == 0) {
        write_obj(m, out);
    } else if (strcmp(format, "ply-ascii") == 0) {
        write_ply(m, out, "ascii");
    } else if (strcmp(format, "ply-le") == 0) {
        write_ply(m, out, "binary_little_endian");
    } else if (strcmp(format, "ply-be") == 0) {
        write_ply(m, out, "binary_big_endian");
    } else {
        return false;
    }
    return true;
}

#ifndef CONVERT_NO_MAIN /* test_obj.c takes the rest */
int main(int argc, char **argv) {
    mesh m;
    memset(&m, 0, sizeof m);
    if (argc != 4) {
        (void)fprintf(stderr, "convert IN.(obj|stl|ply) OUT stl|stl-ascii|ply-ascii|ply-le|ply-be|obj\n");
        return 2;
    }
    if (!read_mesh(&m, argv[1])) {
        return 1;
    }
    FILE *out = fopen(argv[2], "wb");
    if (out == NULL) {
        perror(argv[2]);
        return 1;
    }
    const bool known = write_mesh(&m, out, argv[3]), failed = ferror(out) != 0;
    if (fclose(out) != 0 || failed || !known) {
        (void)fprintf(stderr, "convert: %s: %s\n", known ? argv[2] : argv[3], known ? "not written" : "an unknown format");
        return known ? 1 : 2;
    }
    free_mesh(&m);
    return 0;
}
#endif

#else

int main(void) {
    (void)fprintf(stderr, "convert: polygons were switched off when the library was compiled\n");
    return 2;
}

#endif
