/*
 * fuzz_ply.c - the reader of PLY. First byte: pieces, failing reads, smooth, whether the size is known; second and third:
 * the vertex store's bytes, with a spill file or without, and when that fails; the rest: the file.
 */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    aset_load_options options;
    aset_vertex_store store;
    spill file = {NULL, 0, 0};
    if (size < 3) {
        return 0;
    }
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
    /* The second time fewer calls would be left: a failing file is for the reader alone, and read only once. */
    file.fails_in = data[2] >= 128 ? data[2] - 127u : 0;
    options.smooth = (data[0] & 32u) != 0;
    options.size = (data[0] & 64u) != 0 ? size - 3 : 0;
    options.vertices = &store;
    if (file.fails_in > 0) {
        aset_counter counter;
        aset_load_report report;
        aset_sink sink = aset_counter_sink(&counter);
        source from = source_of(data + 3, size - 3, data[0]);
        check_report(aset_load_ply(&sink, give, &from, &options, &report), &report, size - 3);
    } else {
        read_twice(aset_load_ply, data + 3, size - 3, data[0], &options, 1 << 16);
    }
    free(store.block);
    free(file.bytes);
    return 0;
}
