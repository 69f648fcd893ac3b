/* whole.c - division by hand: 16 bits at a time by small divisors, bit by bit by others. */
#include "base/whole.h"

#if UINTPTR_MAX <= UINT32_MAX
uint64_t aset_whole_divide(uint64_t a, uint64_t b, uint64_t *rest) {
    uint64_t quotient = 0, left = 0;
    if (b <= UINT16_MAX) {
        uint32_t divisor = (uint32_t)b, part = 0;
        for (int i = 0; i < 4; i++) {
            part = part << 16 | (uint32_t)(a >> 48);
            a <<= 16;
            quotient = quotient << 16 | part / divisor;
            part %= divisor;
        }
        *rest = part;
        return quotient;
    }
    for (int i = 0; i < 64; i++) {
        left = left << 1 | a >> 63;
        a <<= 1;
        quotient <<= 1;
        if (left >= b) {
            left -= b;
            quotient |= 1;
        }
    }
    *rest = left;
    return quotient;
}
#endif
