/*
 * texture.c - the equal-weight average of materials, and the bounded texture list (Dauenhauer and Semwal 1990, figure 1:
 * "search existing texture list for texture match").
 *
 * A part is kept in units of 2^-16 and below 2^24 (a Phong exponent of 10^5 takes 33 bits), so 2^24 - 1 objects may share a cell
 * before a sum could leave 64 bits, and more if exponents are smaller: fill's parts need 17 bits. A space's cells are
 * checked for as many (summary.c), a stream for its sum of the largest part (flat_pass.c).
 */
#include "approx/texture.h"

#include "base/real.h"
#include "base/whole.h"
#include "scene/entity.h"

#include <string.h>

#if ASET_WITH_APPROXIMATION

#define UNIT R(65536)
#define PART_MAX R(16777215)

static void parts_of(const aset_material *m, aset_real parts[TEXTURE_PARTS]) {
    memset(parts, 0, TEXTURE_PARTS * sizeof *parts);
    memcpy(parts, m, MATERIAL_AMOUNTS * sizeof *parts);
#if ASET_WITH_REFRACTION
    parts[7] = parts[7] > 0 ? parts[7] : 1; /* 0 means 1, and averages as 1 */
#endif
}

void aset_texture_sum_add(texture_sum *sum, const aset_material *material) {
    aset_real parts[TEXTURE_PARTS];
    parts_of(material, parts);
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        aset_real units = real_min(parts[i], PART_MAX) * UNIT;
        int64_t whole = real_to_whole(units); /* units + 1/2 would be rounded itself where units are large */
        sum->parts[i] += (uint64_t)(whole + (units - real_of_whole(whole) >= R(0.5)));
    }
    sum->n++;
}

aset_material aset_texture_average(const texture_sum *sum) {
    aset_real parts[TEXTURE_PARTS];
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        parts[i] = real_of_whole((int64_t)whole_quotient(sum->parts[i] + sum->n / 2, sum->n)) / UNIT;
    }
    aset_material m;
    memcpy(&m, parts, MATERIAL_AMOUNTS * sizeof *parts);
    m.one_sided = false;
    return m;
}

/*
 * How different two textures look: squared differences of what they add to a pixel. The exponent and the index of refraction
 * count by their ratio, since 10 and 20 differ more than 1000 and 1010.
 */
static aset_real texture_difference(const aset_material *a, const aset_material *b) {
    aset_real p[TEXTURE_PARTS], q[TEXTURE_PARTS], sum = 0;
    parts_of(a, p);
    parts_of(b, q);
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        aset_real d = p[i] - q[i];
        if (i == 5 || i == 7) {
            d = d / (p[i] + q[i] + 1);
        }
        sum += d * d;
    }
    return sum;
}

bool aset_texture_find(const aset_summary *summary, const aset_material *texture, uint32_t *number) {
    for (uint32_t i = 0; i < summary->n_textures; i++) {
        if (entity_same_look(summary->textures + i, texture)) {
            *number = i;
            return true;
        }
    }
    return false;
}

uint32_t aset_texture_nearest(const aset_summary *summary, const aset_material *texture) {
    uint32_t nearest = 0;
    aset_real least = REAL_INFINITY;
    for (uint32_t i = 0; i < summary->n_textures; i++) {
        aset_real difference = texture_difference(summary->textures + i, texture);
        if (difference < least) {
            least = difference;
            nearest = i;
        }
    }
    return nearest;
}

unsigned aset_texture_slot(const texture_sum *sum) {
    uint64_t hash = 0;
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        hash = (hash ^ whole_quotient(sum->parts[i], sum->n)) * UINT64_C(0x9e3779b97f4a7c15);
    }
    return (unsigned)(hash >> 58); /* 0 to TEXTURE_RECENT - 1 */
}

uint32_t aset_texture_take(aset_summary *summary, texture_recent *recent, const texture_sum *sum) {
    unsigned slot = aset_texture_slot(sum);
    aset_material texture = aset_texture_average(sum);
    if (recent->known[slot] && entity_same_look(&texture, &recent->textures[slot])) {
        return recent->number[slot];
    }
    uint32_t number = summary->n_textures;
    bool is_own = aset_texture_find(summary, &texture, &number);
    if (!is_own && number < summary->capacity) {
        summary->textures[summary->n_textures++] = texture;
        is_own = true;
    } else if (!is_own) {
        number = aset_texture_nearest(summary, &texture);
        summary->merged++;
    }
    recent->textures[slot] = texture;
    recent->number[slot] = number;
    recent->known[slot] = is_own; /* one that had to share is counted each time */
    return number;
}

#endif
