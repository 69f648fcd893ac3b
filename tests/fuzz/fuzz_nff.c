/* fuzz_nff.c - the reader of NFF. First byte: pieces, failing reads, one-sidedness; the rest is the file. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    aset_load_options options;
    memset(&options, 0, sizeof options);
    if (size > 0) {
        options.one_sided_opaque = (data[0] & 64u) != 0;
        read_twice(aset_load_nff, data + 1, size - 1, data[0], &options, 1 << 16);
    }
    return 0;
}
