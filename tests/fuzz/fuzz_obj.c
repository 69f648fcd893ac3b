/*
 * fuzz_obj.c - the reader of OBJ and of material libraries. First byte: pieces, failing reads, smooth; second and third: the
 * vertex store's bytes, with a spill file or without, and when that fails; fourth: how many named materials are kept; fifth
 * and sixth: bytes of the OBJ. What is behind them is the library, whatever name is asked for that is not "no".
 */
#include "fuzz.h"

#define HEAD 6u

typedef struct shelf {
    source file;
    const uint8_t *data;
    size_t size;
    uint32_t choice;
    bool open;
} shelf;

static bool shelf_open(void *context, const char *name, aset_read *read, void **stream) {
    shelf *s = context;
    require(!s->open);
    if (strcmp(name, "no") == 0) {
        return false;
    }
    s->file = source_of(s->data, s->size, s->choice);
    s->open = true;
    *read = give;
    *stream = &s->file;
    return true;
}

static void shelf_close(void *context, void *stream) {
    shelf *s = context;
    require(s->open && stream == &s->file);
    s->open = false;
}

static void run(const uint8_t *data, size_t size, const aset_load_options *options, size_t n_obj, const spill *file) {
    if (file->fails_in > 0) {
        aset_counter counter;
        aset_load_report report;
        aset_sink sink = aset_counter_sink(&counter);
        source from = source_of(data + HEAD, n_obj, data[0]);
        check_report(aset_load_obj(&sink, give, &from, options, &report), &report, size);
    } else {
        read_twice(aset_load_obj, data + HEAD, n_obj, data[0], options, 1 << 16);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    aset_load_options options;
    aset_vertex_store store;
    aset_named_material materials[8];
    spill file = {NULL, 0, 0};
    if (size < HEAD) {
        return 0;
    }
    size_t n_obj = data[4] + 256u * data[5];
    n_obj = n_obj < size - HEAD ? n_obj : size - HEAD;
    shelf books = {{{NULL, NULL}, 0, false}, data + HEAD + n_obj, size - HEAD - n_obj, data[3] >> 4, false};
    aset_library library = {shelf_open, shelf_close, &books};
    memset(&options, 0, sizeof options);
    memset(&store, 0, sizeof store);
    store.size = data[1] % 4 == 3 ? ASET_BYTES_WINDOW + data[1] : (size_t)data[1] * 8;
    store.block = malloc(store.size > 0 ? store.size : 1);
    require(store.block != NULL);
    if (data[2] % 2 == 1) {
        store.write = spill_write;
        store.read = spill_read;
        store.context = &file;
    }
    file.fails_in = data[2] >= 128 ? data[2] - 127u : 0;
    options.smooth = (data[0] & 64u) != 0;
    options.vertices = &store;
    options.library = (data[0] & 128u) != 0 ? NULL : &library;
    options.n_materials = data[3] % 8;
    options.materials = options.n_materials > 0 ? materials : NULL;
    run(data, size, &options, n_obj, &file);
    require(!books.open);
    free(store.block);
    free(file.bytes);
    return 0;
}
