/*
 * fuzz_draft.c - opening a draft, and rays through what was opened. First byte: whether mark, version, length and check sum
 * are put right first, so that what lies behind them is reached; the stage's memory; the rest: the words.
 */
#include "draw.h"

#if ASET_WITH_DRAFTS

#include "approx/facet.h"

static void put_right(uint32_t *words, size_t n_words) {
    words[WORD_MAGIC] = FACET_MAGIC;
    words[WORD_VERSION] = FACET_VERSION;
    words[WORD_N_WORDS] = (uint32_t)n_words;
    words[WORD_CHECK] = aset_draft_checksum(words, n_words);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 1) {
        return 0;
    }
    size_t n_words = (size - 1) / 4;
    uint32_t *words = malloc(n_words > 0 ? n_words * 4 : 4);
    aset_arena arena = open_arena((data[0] & 2u) != 0 ? 400 : 1 << 14);
    aset_draft draft;
    const char *why = NULL;
    require(words != NULL);
    memcpy(words, data + 1, n_words * 4);
    if ((data[0] & 1u) == 0 && n_words >= WORDS_HEADER) {
        put_right(words, n_words);
    }
    aset_status status = aset_draft_open(&draft, words, n_words, &arena, &why);
    require(status == ASET_OK || arena.used == 0);
    require((status == ASET_ERR_SYNTAX) == (why != NULL));
    if (status == ASET_OK) {
        draw_draft(&draft, fuzz_choice(data, size));
    }
    close_arena(&arena);
    free(words);
    return 0;
}

#else

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    (void)data, (void)size;
    return 0;
}

#endif
