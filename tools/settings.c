/*
 * settings.c - the words that all commands which draw, plan, measure or bake take alike: where a scene is seen from, what a model
 * gets beside itself, and how rays are followed.
 */
#include "prepare.h"

#include <inttypes.h>
#include <string.h>

settings settings_default(void) {
    settings s;
    memset(&s, 0, sizeof s);
    s.method = &aset_mset;
    s.approx_depth = 1;
    s.tree_depth = SETTINGS_TREE_DEPTH;
    s.curtail = 0.5;
    s.memory = 8u << 20;
    s.samples = 1;
    s.depth = ASET_DEPTH_DEFAULT;
    s.threads = 1;
    return s;
}

static bool parse_samples(settings *s, const char *text) {
    uint32_t n, side = 1;
    if (!tool_parse_count("--samples", text, 1, 4096, &n)) {
        return false;
    }
    while (side * side < n) {
        side++;
    }
    if (side * side != n) {
        tool_error(NULL, 0, "--samples: %" PRIu32 " is no square, expected 1, 4, 9, 16 ...", n);
        return false;
    }
    s->samples = side;
    return true;
}

/* One by one, then those that stand for several. */
static const tool_word kind_words[] = {{"primary", ASET_PRIMARY},     {"shadow", ASET_SHADOW}, {"reflected", ASET_REFLECTED},
                                       {"refracted", ASET_REFRACTED}, {"all", ASET_ALL_KINDS}, {"none", 0},
                                       {NULL, 0}};

void settings_kinds(char text[SETTINGS_KINDS_BYTES], uint32_t kinds) {
    size_t n = 0;
    for (int i = 0; i < 4 && kinds != ASET_ALL_KINDS; i++) {
        if ((kinds & kind_words[i].value) != 0) {
            n += (size_t)snprintf(text + n, SETTINGS_KINDS_BYTES - n, "%s%s", n > 0 ? "," : "", kind_words[i].name);
        }
    }
    if (n == 0) {
        (void)snprintf(text, SETTINGS_KINDS_BYTES, "%s", kinds == ASET_ALL_KINDS ? "all" : "none");
    }
}

const char *const settings_cells_names[SETTINGS_CELLS] = {"flat", "normal", "plane"};

bool settings_parse_cells(settings *s, const char *text) {
    static const tool_word words[] = {{"flat", CELLS_FLAT}, {"normal", CELLS_NORMAL}, {"plane", CELLS_PLANE}, {NULL, 0}};
    unsigned word = 0;
    bool done = tool_parse_word("--cells", text, words, &word);
    s->cells = (settings_cells)word;
    return done;
}

static bool drawing_option(settings *s, int option) {
    static const tool_word sides[] = {{"less", 0}, {"more", 1}, {NULL, 0}}, rules[] = {{"spd", 1}, {"off", 0}, {NULL, 0}};
    unsigned word = 0;
    switch (option) {
    case SETTINGS_APPROX:
        if (!tool_parse_words("--approx", optarg, kind_words, &word)) {
            return false;
        }
        s->approx_kinds = word;
        s->has_approx = true;
        return true;
    case SETTINGS_APPROX_DEPTH:
        s->has_approx_depth = true;
        return tool_parse_count("--approx-depth", optarg, 0, ASET_DEPTH_MAX, &s->approx_depth);
    case SETTINGS_LEAF: return tool_parse_count("--leaf", optarg, 1, UINT32_MAX, &s->leaf);
    case SETTINGS_CURTAIL: s->has_curtail = true; return tool_parse_real("--curtail", optarg, 0, 1e6, &s->curtail);
    case SETTINGS_CURTAIL_WHEN:
        if (!tool_parse_word("--curtail-when", optarg, sides, &word)) {
            return false;
        }
        s->curtail_more = word != 0;
        return true;
    case SETTINGS_SAMPLES: return parse_samples(s, optarg);
    case SETTINGS_DEPTH: return tool_parse_count("--depth", optarg, 1, ASET_DEPTH_MAX, &s->depth);
    case SETTINGS_RULES:
        if (!tool_parse_word("--rules", optarg, rules, &word)) {
            return false;
        }
        s->spd_rules = word != 0;
        return true;
    default: return false;
    }
}

bool settings_option(settings *s, int option) {
    static const tool_word axes[] = {{"y", ASET_UP_Y}, {"z", ASET_UP_Z}, {NULL, 0}};
    unsigned word = 0;
    switch (option) {
    case SETTINGS_FROM: s->has_from = true; return tool_parse_vec3("--from", optarg, &s->from);
    case SETTINGS_AT: s->has_at = true; return tool_parse_vec3("--at", optarg, &s->at);
    case SETTINGS_UP: s->has_up = true; return tool_parse_vec3("--up", optarg, &s->up);
    case SETTINGS_ANGLE: s->has_angle = true; return tool_parse_real("--angle", optarg, 0.001, 179.999, &s->angle_deg);
    case SETTINGS_UP_AXIS:
        if (!tool_parse_word("--up-axis", optarg, axes, &word)) {
            return false;
        }
        s->has_up_axis = true;
        s->up_axis = (aset_up)word;
        return true;
    case SETTINGS_GROUND: s->has_ground = true; return tool_parse_switch("--ground", optarg, &s->ground);
    case SETTINGS_SMOOTH: s->smooth = true; return true;
    default: return drawing_option(s, option);
    }
}

bool settings_check(const settings *s) {
    if (s->spd_rules && s->samples > 1) {
        tool_error(NULL, 0, "--rules: the SPD procedure has one ray a pixel corner, expected no --samples");
        return false;
    }
    return true;
}

bool settings_view(aset_view *view, const settings *s, const char *path) {
    view->from = s->has_from ? s->from : view->from;
    view->at = s->has_at ? s->at : view->at;
    view->up = s->has_up ? s->up : view->up;
    if (s->has_angle) {
        view->angle_deg = (aset_real)s->angle_deg;
        view->height = 0;
    }
    aset_counter ignored;
    aset_sink check = aset_counter_sink(&ignored);
    if (check.view(check.context, view) != ASET_OK) {
        tool_error(path, 0, "the view has no direction, up lies along it, or it is beyond 10^30; expected other --from, --at or --up");
        return false;
    }
    return true;
}
