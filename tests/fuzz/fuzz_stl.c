/*
 * fuzz_stl.c - the reader of STL. First byte: pieces, failing reads, whether the size is known, and truly; the rest: the
 * file.
 */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    aset_load_options options;
    memset(&options, 0, sizeof options);
    if (size > 0) {
        options.size = (data[0] & 64u) != 0 ? size - 1 + data[0] / 128 : 0;
        read_twice(aset_load_stl, data + 1, size - 1, data[0], &options, 1 << 16);
    }
    return 0;
}
