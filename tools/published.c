/*
 * published.c - the numbers of Tables 1 to 4 as printed.
 *
 * The last row has no name but Gears and no divisions in the paper; its density is that of Gears 15. It stands in no
 * Table 4, so its secondary rays are all rays less the primary rays of Gears 15: the same picture with a deeper tree of
 * rays.
 *
 * The paper does not print the height of its ray trees. depth is that at which MSET's secondary rays for each primary ray
 * come nearest to the published; the last row's is where the count has stopped growing.
 */
#include "published.h"

#define GEARS_PRIMARY 260088.0

const published_row published_rows[PUBLISHED_ROWS] = {
    {"Snow 100", "snow", 0, 100, 3, {7943.9, 8644.6}, {667239, 841883}, {78, 121}, 1.3, {18, 1}, {21, 1},
     {0.048, 0.107}, {6421644, 4541077}, {5808708, 7488824}, 511547, {155692, 330336}},
    {"Snow 50", "snow", 0, 50, 3, {11540.0, 11330.6}, {667239, 851461}, {47, 114}, 2.1, {32, 1}, {64, 1},
     {0.019, 0.035}, {19367605, 13241396}, {906864, 1146980}, 511547, {155692, 339914}},
    {"Snow 30", "snow", 0, 30, 3, {22434.6, 17939.3}, {667239, 780719}, {21, 137}, 3.9, {43, 1}, {162, 1},
     {0.006, 0.012}, {51621849, 36169829}, {311362, 390404}, 511547, {155692, 269172}},
    {"Teapot 15", "teapot", 3, 15, 2, {3976.0, 3089.9}, {353480, 402145}, {55, 138}, 4.6, {8, 1}, {36, 1},
     {0, 0}, {0, 0}, {0, 0}, 244291, {109189, 157854}},
    {"Tetra 10", "tetra-moon", 0, 10, 5, {16791.8, 12182.6}, {1049047, 1668085}, {57, 148}, 11.4, {5, 1}, {61, 1},
     {0, 0}, {0, 0}, {0, 0}, 245449, {803598, 1422636}},
    {"Gears 15", "gears", 2, 15, 2, {3475.4, 3102.9}, {320312, 327640}, {56, 92}, 6.8, {3, 1}, {18, 1},
     {0, 0}, {0, 0}, {0, 0}, GEARS_PRIMARY, {60224, 67552}},
    {"Gears, deep", "gears", 2, 15, 8, {10952.4, 5543.6}, {697660, 643389}, {57, 148}, 6.8, {3.5, 1}, {25, 1},
     {0, 0}, {0, 0}, {0, 0}, GEARS_PRIMARY, {697660 - GEARS_PRIMARY, 643389 - GEARS_PRIMARY}},
};

double published_primary_share(const published_row *row, int by) {
    return 1.0 - row->secondary[by] / row->rays_per_second[by] / row->seconds[by];
}

double published_secondary_tests(const published_row *row) {
    if (row->attempts[BY_MSET] > 0.0) {
        return (row->attempts[BY_MSET] - row->attempts[BY_ASET]) / row->secondary[BY_MSET];
    }
    return (1.0 / row->rays_per_second[BY_MSET] - PUBLISHED_RAY_S) / PUBLISHED_TEST_S;
}

double published_hit_share(const published_row *row) {
    return row->hit_ratio[BY_MSET] * row->attempts[BY_MSET] / row->rays[BY_MSET];
}
