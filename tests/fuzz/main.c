/* main.c - runs a fuzzer over files, for compilers without libFuzzer and for the corpus as a test: fuzz_nff FILE ... */
#include "fuzz.h"

static void run(const char *name) {
    static uint8_t buffer[1 << 20];
    FILE *file = fopen(name, "rb");
    if (file == NULL) {
        perror(name);
        exit(1);
    }
    size_t size = fread(buffer, 1, sizeof buffer, file);
    fclose(file);
    uint8_t *data = malloc(size > 0 ? size : 1); /* exactly so large, for the sanitizer */
    require(data != NULL);
    memcpy(data, buffer, size);
    (void)LLVMFuzzerTestOneInput(data, size);
    free(data);
}

int main(int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        fprintf(stderr, "%s\n", argv[i]); /* so that a crash tells its file */
        run(argv[i]);
    }
    return 0;
}
