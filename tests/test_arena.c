/* test_arena.c - the bump allocator: what fits, what does not, and what is accounted. */
#include "support/support.h"

#include <fenv.h>
#include <float.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

static void test_arena__start_refuses_bad_blocks(void **state) {
    (void)state;
    uint64_t words[4];
    aset_arena arena;
    assert_int_equal(aset_arena_init(NULL, words, sizeof words), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_arena_init(&arena, NULL, 8), ASET_ERR_ARGUMENT);
    for (size_t shift = 1; shift < ASET_ALIGN; shift++) {
        assert_int_equal(aset_arena_init(&arena, (unsigned char *)words + shift, 16), ASET_ERR_ARGUMENT);
    }
    assert_int_equal(aset_arena_init(&arena, words, sizeof words), ASET_OK);
    assert_true(arena.size == sizeof words && arena.used == 0 && arena.peak == 0);
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        assert_true(arena.used_by[i] == 0 && arena.peak_by[i] == 0);
    }
}

/* Whoever sets the processor's rounding otherwise is told so, and can start once it is set back. */
static void test_arena__start_refuses_other_arithmetic(void **state) {
    (void)state;
    uint64_t words[4];
    aset_arena arena;
    static const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    for (size_t i = 0; i < COUNT_OF(modes); i++) {
        assert_int_equal(fesetround(modes[i]), 0);
        aset_status status = aset_arena_init(&arena, words, sizeof words);
        fesetround(FE_TONEAREST);
        assert_int_equal(status, ASET_ERR_ARITHMETIC);
    }
#ifdef __SSE__
    unsigned before = _mm_getcsr();
    static const unsigned flushing[] = {0x8000u, 0x0040u}; /* results, operands */
    for (size_t i = 0; i < COUNT_OF(flushing); i++) {
        _mm_setcsr(before | flushing[i]);
        volatile float least = FLT_MIN, less = least / 2;
        volatile bool flushed = !(less + less == least); /* an emulator may not know how; found before the mode is set back */
        aset_status status = aset_arena_init(&arena, words, sizeof words);
        _mm_setcsr(before);
        assert_int_equal(status, flushed ? ASET_ERR_ARITHMETIC : ASET_OK);
    }
#endif
    assert_int_equal(aset_arena_init(&arena, words, sizeof words), ASET_OK);
}

static void test_arena__size_zero_gives_nothing(void **state) {
    (void)state;
    uint64_t word = 0;
    void *const blocks[2] = {NULL, &word};
    for (int i = 0; i < 2; i++) {
        aset_arena arena;
        assert_int_equal(aset_arena_init(&arena, blocks[i], 0), ASET_OK);
        assert_null(aset_arena_alloc(&arena, 1, ASET_CATEGORY_CELLS));
        assert_int_equal(arena.missing, 8);
        assert_null(aset_arena_alloc(&arena, 24, ASET_CATEGORY_CELLS));
        assert_int_equal(arena.missing, 24);
        (void)aset_arena_alloc(&arena, 0, ASET_CATEGORY_CELLS); /* whatever it gives: a sanitizer sees whether it may */
        assert_true(arena.used == 0 && arena.peak == 0 && arena.used_by[ASET_CATEGORY_CELLS] == 0);
        assert_true(aset_arena_fits(&arena, 0));
        assert_false(aset_arena_fits(&arena, 1));
    }
}

static void test_arena__gives_aligned_pieces_in_a_row(void **state) {
    (void)state;
    guarded g = guarded_open(4096);
    aset_arena arena;
    assert_int_equal(aset_arena_init(&arena, g.block, g.size), ASET_OK);
    unsigned char *expected = g.block;
    for (size_t bytes = 0; bytes <= 40; bytes++) {
        unsigned char *piece = aset_arena_alloc(&arena, bytes, ASET_CATEGORY_OBJECTS);
        assert_ptr_equal(piece, expected);
        assert_int_equal((uintptr_t)piece % ASET_ALIGN, 0);
        memset(piece, 0x11, bytes);
        expected += (bytes + 7) / 8 * 8;
        assert_int_equal(arena.used, expected - (unsigned char *)g.block);
    }
    assert_int_equal(arena.used_by[ASET_CATEGORY_OBJECTS], arena.used);
    guarded_close(&g);
}

static void test_arena__exact_fit(void **state) {
    (void)state;
    for (size_t need = 8; need <= 256; need += 8) {
        guarded g = guarded_open(need);
        aset_arena arena;
        assert_int_equal(aset_arena_init(&arena, g.block, need), ASET_OK);
        void *piece = aset_arena_alloc(&arena, need - 3, ASET_CATEGORY_VOXELS);
        assert_non_null(piece);
        memset(piece, 0x22, need);
        assert_int_equal(arena.used, need);
        assert_null(aset_arena_alloc(&arena, 1, ASET_CATEGORY_VOXELS));
        assert_int_equal(arena.missing, 8);
        guarded_close(&g);
    }
}

static void test_arena__one_less_fails_and_changes_nothing(void **state) {
    (void)state;
    uint64_t words[16];
    for (size_t short_by = 1; short_by <= 9; short_by++) {
        aset_arena arena;
        assert_int_equal(aset_arena_init(&arena, words, sizeof words - short_by), ASET_OK);
        assert_non_null(aset_arena_alloc(&arena, 32, ASET_CATEGORY_CELLS));
        aset_arena before = arena;
        assert_null(aset_arena_alloc(&arena, sizeof words - 32, ASET_CATEGORY_TEXTURES));
        assert_int_equal(arena.missing, short_by);
        before.missing = arena.missing;
        assert_memory_equal(&before, &arena, sizeof arena);
        assert_false(aset_arena_fits(&arena, sizeof words - 32));
        assert_true(aset_arena_fits(&arena, sizeof words - 32 - short_by));
        assert_memory_equal(&before, &arena, sizeof arena);
    }
}

static void test_arena__sizes_that_overflow_fail(void **state) {
    (void)state;
    uint64_t words[4];
    aset_arena arena;
    assert_int_equal(aset_arena_init(&arena, words, sizeof words), ASET_OK);
    assert_non_null(aset_arena_alloc(&arena, 8, ASET_CATEGORY_CELLS));
    for (size_t i = 0; i < 20; i++) {
        arena.missing = 0;
        assert_null(aset_arena_alloc(&arena, SIZE_MAX - i, ASET_CATEGORY_CELLS));
        assert_true(arena.missing > SIZE_MAX / 2);
        assert_int_equal(arena.used, 8);
    }
    assert_false(aset_arena_fits(&arena, SIZE_MAX));
}

static void test_arena__accounts_by_category(void **state) {
    (void)state;
    uint64_t words[256];
    aset_arena arena;
    size_t sum = 0;
    assert_int_equal(aset_arena_init(&arena, words, sizeof words), ASET_OK);
    for (int round = 1; round <= 3; round++) {
        for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
            size_t bytes = (size_t)(8 * i + round);
            assert_non_null(aset_arena_alloc(&arena, bytes, (aset_category)i));
            sum += ASET_ROUND(bytes);
            assert_int_equal(arena.used, sum);
        }
    }
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        assert_int_equal(arena.used_by[i], 3 * 8 * (i + 1));
        assert_int_equal(arena.peak_by[i], arena.used_by[i]);
    }
}

static void test_arena__release_goes_back_and_peaks_stay(void **state) {
    (void)state;
    uint64_t words[64];
    aset_arena arena;
    assert_int_equal(aset_arena_init(&arena, words, sizeof words), ASET_OK);
    assert_non_null(aset_arena_alloc(&arena, 24, ASET_CATEGORY_OBJECTS));
    aset_mark outer = aset_arena_mark(&arena);
    void *first = aset_arena_alloc(&arena, 64, ASET_CATEGORY_CELLS);
    aset_mark inner = aset_arena_mark(&arena);
    assert_non_null(aset_arena_alloc(&arena, 128, ASET_CATEGORY_SCRATCH));
    aset_arena_release(&arena, &inner);
    assert_int_equal(arena.used, 24 + 64);
    assert_int_equal(arena.used_by[ASET_CATEGORY_SCRATCH], 0);
    assert_int_equal(arena.used_by[ASET_CATEGORY_CELLS], 64);
    aset_arena_release(&arena, &outer);
    assert_int_equal(arena.used, 24);
    assert_int_equal(arena.used_by[ASET_CATEGORY_OBJECTS], 24);
    assert_int_equal(arena.used_by[ASET_CATEGORY_CELLS], 0);
    assert_int_equal(arena.peak, 24 + 64 + 128);
    assert_int_equal(arena.peak_by[ASET_CATEGORY_CELLS], 64);
    assert_int_equal(arena.peak_by[ASET_CATEGORY_SCRATCH], 128);
    assert_ptr_equal(aset_arena_alloc(&arena, 8, ASET_CATEGORY_CELLS), first);
    assert_int_equal(arena.peak, 24 + 64 + 128);
    assert_non_null(aset_arena_alloc(&arena, 512 - 32, ASET_CATEGORY_CELLS));
    assert_int_equal(arena.peak, 512);
    assert_int_equal(arena.peak_by[ASET_CATEGORY_CELLS], 512 - 24);
}

static void test_arena__every_category_has_a_name(void **state) {
    (void)state;
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        assert_true(strlen(aset_category_name((aset_category)i)) > 0);
        assert_true(strlen(aset_category_text((aset_category)i)) > 0);
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(aset_category_name((aset_category)i), aset_category_name((aset_category)k));
        }
    }
    assert_string_equal(aset_category_name(ASET_CATEGORY_OBJECTS), "objects");
    assert_string_equal(aset_category_name(ASET_CATEGORY_SCRATCH), "scratch");
    assert_null(aset_category_name(ASET_CATEGORY_COUNT));
    assert_null(aset_category_text(ASET_CATEGORY_COUNT));
    assert_null(aset_category_name((aset_category)-1));
    assert_null(aset_category_text((aset_category)1000));
}

static void test_arena__static_blocks_are_large_enough_and_aligned(void **state) {
    (void)state;
    static ASET_ARENA_BLOCK(block, 41);
    aset_arena arena;
    assert_int_equal(sizeof block, 48);
    assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
    assert_non_null(aset_arena_alloc(&arena, 41, ASET_CATEGORY_CELLS));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arena__start_refuses_bad_blocks),
        cmocka_unit_test(test_arena__start_refuses_other_arithmetic),
        cmocka_unit_test(test_arena__size_zero_gives_nothing),
        cmocka_unit_test(test_arena__gives_aligned_pieces_in_a_row),
        cmocka_unit_test(test_arena__exact_fit),
        cmocka_unit_test(test_arena__one_less_fails_and_changes_nothing),
        cmocka_unit_test(test_arena__sizes_that_overflow_fail),
        cmocka_unit_test(test_arena__accounts_by_category),
        cmocka_unit_test(test_arena__release_goes_back_and_peaks_stay),
        cmocka_unit_test(test_arena__every_category_has_a_name),
        cmocka_unit_test(test_arena__static_blocks_are_large_enough_and_aligned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
