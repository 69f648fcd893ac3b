/*
 * mpi_render.c - one picture by many processes: rank 0 deals rows from a queue and collects them, all others draw.
 *
 *     mpirun -n 8 mpi_render SCENE.nff OUT.ppm [WIDTHxHEIGHT]      exact, the bytes of aset render SCENE.nff -o OUT.ppm
 *     mpirun -n 8 mpi_render MODEL.draft OUT.ppm [WIDTHxHEIGHT]    a draft that aset bake made, of 26 to 520 kB
 *
 * Rank 0 alone reads the file and hands its bytes to all, so no shared folder is needed. Rows are dealt in runs that become
 * shorter towards the end (guided self-scheduling, Polychronopoulos and Kuck 1987: the rest by twice the ranks), so a slow rank
 * takes fewer. When no row is left to be dealt, those still on their way are dealt a second time to who has nothing to
 * do, and the first answer counts: both are the same bytes. So the picture waits for no rank, unless one stops in the midst of
 * sending, and the end waits for one row of it.
 * The picture stands in rank 0's memory and gets its name when it is whole; a rank that fails ends all of them with one
 * line and status 1.
 */
#include <aset/aset.h>
#include <aset/load.h>

#include <limits.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define ARENA_BYTES ((size_t)64 << 20)
#define SIDE_MAX 65535
#define RUN_MAX 64        /* rows in a run at the most: what a rank's answer takes in memory */
#define DRAWING_DEALER 16 /* among more ranks than this rank 0 only deals */

enum { ANSWER = 1, RUN, DISMISSED, FAREWELL };

/* What rank 0 keeps of the queue. */
typedef struct queue {
    unsigned char *pixels, *is_done, *n_dealt; /* the picture; for each row: is it here, how often was it given out */
    uint32_t next, n_left;                     /* the first row not dealt yet; rows that are not here */
    unsigned long n_messages, n_twice;
    unsigned long *by_rank;      /* rows that each rank was the first to bring */
    double drawing_s, busiest_s; /* processor time of all that was drawn, and of the rank that drew longest */
} queue;

/* Everything that draws: the same on each rank. */
typedef struct drawing {
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_draft draft;
    aset_scratch scratch;
    aset_tracer tracer;
    aset_view view;
    size_t row_bytes;
} drawing;

static int rank, n_ranks;
static drawing d;
static double drawing_s; /* processor time of this rank's draw */

/* One line, and the end of all ranks. */
static void fail(const char *subject, const char *what) {
    fprintf(stderr, "mpi_render: rank %d: %s: %s\n", rank, subject, what);
    MPI_Abort(MPI_COMM_WORLD, 1);
    exit(1);
}

static void *take(size_t size) {
    void *block = malloc(size > 0 ? size : 1);
    if (block == NULL) {
        fail("memory", "the machine has no block of the size that is needed");
    }
    return block;
}

/* ---- the scene, on every rank ---- */

/* Rank 0 reads the file; all get its bytes. */
static unsigned char *share_file(const char *path, size_t *size) {
    unsigned long long n = 0;
    unsigned char *bytes = NULL;
    if (rank == 0) {
        FILE *file = fopen(path, "rb");
        if (file == NULL || fseek(file, 0, SEEK_END) != 0 || ftell(file) < 1) {
            fail(path, "cannot be read, or is empty");
        }
        n = (unsigned long long)ftell(file);
        bytes = take((size_t)n);
        rewind(file);
        if (fread(bytes, 1, (size_t)n, file) != n) {
            fail(path, "cannot be read");
        }
        fclose(file);
    }
    MPI_Bcast(&n, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    bytes = rank == 0 ? bytes : take((size_t)n);
    for (size_t at = 0; at < n; at += 1 << 20) {
        MPI_Bcast(bytes + at, (int)(n - at < 1 << 20 ? n - at : 1 << 20), MPI_BYTE, 0, MPI_COMM_WORLD);
    }
    *size = (size_t)n;
    return bytes;
}

typedef struct bytes_left {
    const unsigned char *at;
    size_t n;
} bytes_left;

static ptrdiff_t read_bytes(void *context, void *buffer, size_t size) {
    bytes_left *left = context;
    size = size < left->n ? size : left->n;
    memcpy(buffer, left->at, size);
    left->at += size;
    left->n -= size;
    return (ptrdiff_t)size;
}

static void load(const aset_sink *sink, const char *path, const unsigned char *bytes, size_t size) {
    bytes_left left = {bytes, size};
    aset_load_report report;
    aset_status status = aset_load_nff(sink, read_bytes, &left, NULL, &report);
    if (status != ASET_OK) {
        char where[256];
        snprintf(where, sizeof where, "%.200s:%lu", path, (unsigned long)report.line);
        fail(where, report.what != NULL ? report.what : aset_status_text(status));
    }
}

/* Twice through the bytes: to count, and to build. */
static void open_scene(const char *path, const unsigned char *bytes, size_t size) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    load(&sink, path, bytes, size);
    aset_status status = aset_scene_init(&d.scene, &d.arena, &counter.counts);
    if (status == ASET_OK) {
        sink = aset_scene_sink(&d.scene);
        load(&sink, path, bytes, size);
        status = aset_space_build(&d.space, &d.scene, &aset_mset, NULL, &d.arena);
    }
    if (status != ASET_OK) {
        fail(path, aset_status_text(status));
    }
    d.tracer.scene = &d.scene;
    d.tracer.space = &d.space;
    d.view = d.scene.view;
}

/* A file has the lowest byte of each word first. */
static void open_draft(const char *path, const unsigned char *bytes, size_t size) {
    const char *why = NULL;
    uint32_t *words = take(size);
    for (size_t i = 0; i < size / 4; i++, bytes += 4) {
        words[i] = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    }
    aset_status status = aset_draft_open(&d.draft, words, size / 4, &d.arena, &why);
    if (status != ASET_OK) {
        fail(path, why != NULL ? why : aset_status_text(status));
    }
    d.tracer.scene = &d.draft.stage;
    d.tracer.draft = &d.draft;
    d.tracer.approx_kinds = ASET_ALL_KINDS;
    d.tracer.curtail = 0.5f;
    d.view = d.draft.stage.view;
}

static void prepare(const char *path, const char *size_text) {
    size_t size, length = strlen(path);
    unsigned long width = 0, height = 0;
    char more;
    unsigned char *bytes = share_file(path, &size);
    if (aset_arena_init(&d.arena, take(ARENA_BYTES), ARENA_BYTES) != ASET_OK ||
        aset_scratch_init(&d.scratch, 0, &d.arena) != ASET_OK) {
        fail("memory", "no arena");
    }
    if (length > 6 && strcmp(path + length - 6, ".draft") == 0) {
        open_draft(path, bytes, size);
    } else {
        open_scene(path, bytes, size);
    }
    free(bytes);
    if (size_text != NULL && sscanf(size_text, "%5lux%5lu%c", &width, &height, &more) != 2) {
        fail(size_text, "not a size, expected WIDTHxHEIGHT");
    }
    d.view.width_px = width > 0 ? (uint32_t)width : d.view.width_px > 0 ? d.view.width_px : 512;
    d.view.height_px = height > 0 ? (uint32_t)height : d.view.height_px > 0 ? d.view.height_px : 512;
    if (d.view.width_px > SIDE_MAX || d.view.height_px > SIDE_MAX) {
        fail(path, "a picture of more than 65535 pixels on a side");
    }
    d.row_bytes = (size_t)3 * d.view.width_px;
}

static void draw(unsigned char *to, uint32_t row) {
    const aset_picture picture = {.width = d.view.width_px, .height = d.view.height_px, .pixels = to};
    clock_t start = clock();
    aset_status status = aset_render_rows(&d.tracer, &d.view, &picture, row, 1, &d.scratch, NULL);
    if (status != ASET_OK) {
        fail("drawing", aset_status_text(status));
    }
    drawing_s += (double)(clock() - start) / CLOCKS_PER_SEC;
}

/* ---- the other ranks ---- */

/*
 * An answer is the first row's number, how many there are, and their pixels; the first one is empty. Told to go, a rank says
 * farewell, so that nothing is on its way when all end, and how long it drew.
 */
static void serve(void) {
    uint32_t run[2] = {0, 0}, nothing[2];
    unsigned char *answer = take(sizeof run + RUN_MAX * d.row_bytes);
    int dismissed = 0;
    while (!dismissed) {
        MPI_Status status;
        memcpy(answer, run, sizeof run);
        MPI_Send(answer, (int)(sizeof run + run[1] * d.row_bytes), MPI_BYTE, 0, ANSWER, MPI_COMM_WORLD);
        MPI_Recv(run, 2, MPI_UINT32_T, 0, MPI_ANY_TAG, MPI_COMM_WORLD, &status);
        if (status.MPI_TAG == DISMISSED) {
            break;
        }
        for (uint32_t i = 0; i < run[1] && !dismissed; i++) {
            draw(answer + sizeof run + i * d.row_bytes, run[0] + i);
            MPI_Iprobe(0, DISMISSED, MPI_COMM_WORLD, &dismissed, MPI_STATUS_IGNORE);
        }
        if (dismissed) {
            MPI_Recv(nothing, 2, MPI_UINT32_T, 0, DISMISSED, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
    }
    MPI_Send(&drawing_s, (int)sizeof drawing_s, MPI_BYTE, 0, FAREWELL, MPI_COMM_WORLD);
    free(answer);
}

/* ---- rank 0 ---- */

/* The next run of rows that nobody draws; when there is none, the row that was given out least often and is not here. */
static uint32_t deal(queue *q, uint32_t most, uint32_t *first) {
    uint32_t height = d.view.height_px, n = (height - q->next + 2 * (uint32_t)n_ranks - 1) / (2 * (uint32_t)n_ranks);
    if (q->n_left == 0) {
        return 0;
    }
    if (q->next < height) {
        n = n < most ? n : most;
        *first = q->next;
        memset(q->n_dealt + q->next, 1, n);
        q->next += n;
        return n;
    }
    *first = height;
    for (uint32_t row = 0; row < height; row++) {
        if (!q->is_done[row] && (*first == height || q->n_dealt[row] < q->n_dealt[*first])) {
            *first = row;
        }
    }
    q->n_dealt[*first] += q->n_dealt[*first] < UCHAR_MAX;
    return 1;
}

static void keep(queue *q, uint32_t row, const unsigned char *pixels, int from) {
    if (q->is_done[row]) {
        q->n_twice++;
        return;
    }
    memcpy(q->pixels + row * d.row_bytes, pixels, d.row_bytes);
    q->is_done[row] = 1;
    q->by_rank[from]++;
    q->n_left--;
}

static void add_time(queue *q, double s) {
    q->drawing_s += s;
    q->busiest_s = s > q->busiest_s ? s : q->busiest_s;
}

/* Takes one answer, and gives its sender more to do unless all is here. True: it was a farewell. */
static bool take_answer(queue *q, unsigned char *answer) {
    MPI_Status status;
    uint32_t run[2];
    MPI_Recv(answer, (int)(sizeof run + RUN_MAX * d.row_bytes), MPI_BYTE, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD,
             &status);
    q->n_messages++;
    if (status.MPI_TAG == FAREWELL) {
        double s;
        memcpy(&s, answer, sizeof s);
        add_time(q, s);
        return true;
    }
    memcpy(run, answer, sizeof run);
    for (uint32_t i = 0; i < run[1]; i++) {
        keep(q, run[0] + i, answer + sizeof run + i * d.row_bytes, status.MPI_SOURCE);
    }
    run[1] = deal(q, RUN_MAX, &run[0]);
    if (run[1] > 0) {
        MPI_Send(run, 2, MPI_UINT32_T, status.MPI_SOURCE, RUN, MPI_COMM_WORLD);
        q->n_messages++;
    }
    return false;
}

/* Answers go before rows of its own, of which it takes one at a time, so that nobody waits long. */
static void direct(queue *q, unsigned char *answer) {
    unsigned char *row_pixels = take(d.row_bytes);
    bool draws = n_ranks <= DRAWING_DEALER;
    while (q->n_left > 0) {
        int waiting = !draws || (n_ranks > 1 && q->next == d.view.height_px);
        uint32_t row;
        if (!waiting && n_ranks > 1) {
            MPI_Iprobe(MPI_ANY_SOURCE, ANSWER, MPI_COMM_WORLD, &waiting, MPI_STATUS_IGNORE);
        }
        if (waiting) {
            (void)take_answer(q, answer);
        } else if (deal(q, 1, &row) == 1) {
            draw(row_pixels, row);
            keep(q, row, row_pixels, 0);
        }
    }
    free(row_pixels);
}

static void dismiss(queue *q, unsigned char *answer) {
    uint32_t nothing[2] = {0, 0};
    for (int to = 1; to < n_ranks; to++) {
        MPI_Send(nothing, 2, MPI_UINT32_T, to, DISMISSED, MPI_COMM_WORLD);
        q->n_messages++;
    }
    for (int left = n_ranks - 1; left > 0;) {
        left -= take_answer(q, answer);
    }
}

/* Under another name first, so that no half picture ever has this one. */
static void write_picture(const queue *q, const char *path) {
    size_t size = strlen(path) + 32, n = d.row_bytes * d.view.height_px;
    char *temporary = take(size);
    snprintf(temporary, size, "%s.%ld.part", path, (long)getpid());
    FILE *file = fopen(temporary, "wb");
    bool written = file != NULL;
    written =
        written && fprintf(file, "P6\n%lu %lu\n255\n", (unsigned long)d.view.width_px, (unsigned long)d.view.height_px) > 0;
    written = written && fwrite(q->pixels, 1, n, file) == n;
    written = (file == NULL || fclose(file) == 0) && written;
    if (!written || rename(temporary, path) != 0) {
        remove(temporary);
        fail(path, "cannot be written");
    }
    free(temporary);
}

static void tell(const queue *q, double prepared_s, double drawn_s) {
    printf("%d ranks, %.3f s to prepare, %.3f s to draw (%.3f s of processors, %.3f s of the busiest rank), %lu messages, "
           "%lu rows twice; rows by rank:",
           n_ranks, prepared_s, drawn_s, q->drawing_s, q->busiest_s, q->n_messages, q->n_twice);
    for (int i = 0; i < n_ranks; i++) {
        printf(" %lu", q->by_rank[i]);
    }
    printf("\n");
}

static void collect(const char *path, double start, double prepared) {
    queue q = {.n_left = d.view.height_px};
    unsigned char *answer = take(2 * sizeof(uint32_t) + RUN_MAX * d.row_bytes);
    q.pixels = take(d.row_bytes * d.view.height_px);
    q.is_done = take(d.view.height_px);
    q.n_dealt = take(d.view.height_px);
    q.by_rank = take((size_t)n_ranks * sizeof *q.by_rank);
    memset(q.is_done, 0, d.view.height_px);
    memset(q.n_dealt, 0, d.view.height_px);
    memset(q.by_rank, 0, (size_t)n_ranks * sizeof *q.by_rank);
    direct(&q, answer);
    double drawn = MPI_Wtime();
    write_picture(&q, path);
    dismiss(&q, answer);
    add_time(&q, drawing_s);
    tell(&q, prepared - start, drawn - prepared);
    free(q.pixels);
    free(q.is_done);
    free(q.n_dealt);
    free(q.by_rank);
    free(answer);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    double start = MPI_Wtime();
    if (argc != 3 && argc != 4) {
        if (rank == 0) {
            fprintf(stderr, "mpi_render: expected SCENE.nff or MODEL.draft, OUT.ppm and perhaps WIDTHxHEIGHT\n");
        }
        MPI_Finalize();
        return 2;
    }
    prepare(argv[1], argc == 4 ? argv[3] : NULL);
    if (rank == 0) {
        collect(argv[2], start, MPI_Wtime());
    } else {
        serve();
    }
    free(d.arena.block);
    MPI_Finalize();
    return 0;
}
