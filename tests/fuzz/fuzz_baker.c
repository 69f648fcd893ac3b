/*
 * fuzz_baker.c - garbage through the baker in little memory, its words opened and drawn. First four bytes: memory, two for
 * the divisions, choices (a source that fails among them); then entities as fuzz.h reads them. Most are baked small: few objects, few
 * divisions; a large bake takes as long as fifty of these.
 */
#include "draw.h"

#if ASET_WITH_DRAFTS

#define HEAD 4u
#define ENTITIES_MAX 40u
#define ENTITIES_FEW 8u
#define SPHERES_FEW 1u /* of 18,432 quads at the most */
#define LARGE_ONE_IN 256u
#define PASSES_MAX 5000
#define PASSES_FEW 8 /* a small bake of more is given up */

/* Words that the baker made open again, and are drawn as they are. */
static void check_draft(const aset_draft *draft, uint32_t choice) {
    aset_arena arena = open_arena(1 << 15);
    aset_draft opened;
    const char *why = NULL;
    aset_status status = aset_draft_open(&opened, draft->words, draft->n_words, &arena, &why);
    if (status != ASET_OK && status != ASET_ERR_NOMEM) {
        fprintf(stderr, "%s\n", why != NULL ? why : "?");
    }
    require(status == ASET_OK || status == ASET_ERR_NOMEM);
    if (status != ASET_OK || chosen(choice, 2, 0)) {
        draw_draft(draft, choice / 2);
    }
    if (status == ASET_OK && chosen(choice, 2, 1)) {
        draw_draft(&opened, choice / 2);
    }
    close_arena(&arena);
}

static aset_bake_options options_of(const uint8_t *head, bool is_large) {
    aset_bake_options options;
    memset(&options, 0, sizeof options);
    if (head[3] % 8 != 7) {
        uint32_t part = is_large ? 1 : 3;
        options.divisions[0] = 1 + head[1] % 16u / part;
        options.divisions[1] = 1 + head[1] / 16u / part;
        options.divisions[2] = 1 + head[2] % 16u / part;
    }
    options.keep_none = (head[3] & 16u) != 0;
    return options;
}

static size_t room_of(const uint8_t *head, bool is_large) {
    return 1024 + (size_t)head[0] * (!is_large ? 48 : head[0] >= 128 ? 1024 : 256);
}

static void bake(const uint8_t *data, size_t size, bool is_large) {
    aset_bake_options options = options_of(data, is_large);
    aset_arena arena = open_arena(room_of(data, is_large));
    aset_baker *baker = malloc(sizeof *baker);
    aset_draft draft;
    bool again = true, tame;
    require(baker != NULL);
    aset_status status = aset_baker_init(baker, &arena, &options);
    require(status == ASET_OK);
    for (int pass = 0; status == ASET_OK && again; pass++) {
        bytes all = {data + HEAD, data + size};
        aset_sink sink = aset_baker_sink(baker);
        require(pass < PASSES_MAX);
        (void)put_entities_with(all, &sink, is_large ? ENTITIES_MAX : ENTITIES_FEW, is_large ? UINT32_MAX : SPHERES_FEW, &tame);
        bool fails = (data[3] & 32u) != 0 && pass == data[2] / 64; /* the source has */
        if (fails || (!is_large && pass == PASSES_FEW)) {
            aset_baker_abandon(baker);
            status = ASET_ERR_READ;
            break;
        }
        status = aset_baker_pass(baker, &again);
        require(status == ASET_OK || !again);
    }
    if (status == ASET_OK) {
        status = aset_baker_finish(&draft, baker);
    }
    require(status == ASET_OK || status == ASET_ERR_NOMEM || status == ASET_ERR_GEOMETRY || status == ASET_ERR_LIMIT ||
            status == ASET_ERR_READ || status == ASET_ERR_PRECISION);
    require(status == ASET_OK || arena.used == 0);
    require(status != ASET_ERR_NOMEM || arena.missing > 0);
    if (status == ASET_OK) {
        check_draft(&draft, fuzz_choice(data, size) / LARGE_ONE_IN);
    }
    free(baker);
    close_arena(&arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < HEAD + 1) {
        return 0;
    }
    bool is_large = fuzz_choice(data, size) % LARGE_ONE_IN == 0;
    if (is_large || fuzz_all()) {
        bake(data, size, true);
    }
    if (!is_large || fuzz_all()) {
        bake(data, size, false);
    }
    return 0;
}

#else

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    (void)data, (void)size;
    return 0;
}

#endif
