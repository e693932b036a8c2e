// Measures for --stability, whether they keep what is promised, and how they are printed.
//
// SPDX-License-Identifier: MIT
#include "check/stability.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/json.h"
#include "study/oracle.h"

enum { SEED = 20262, DISTANCE_CASES = 500 };

// ---- measuring

static bool measure_families(Stability *stability, uint64_t cases, uint64_t seed)
{
    size_t count = study_family_count();
    for (size_t i = 0; i < count && i < FAMILIES_MOST; i++) {
        if (!study_family(i, cases, seed, &stability->families[i])) {
            return false;
        }
        stability->family_count++;
    }
    return study_distances(cases < DISTANCE_CASES ? cases : DISTANCE_CASES, seed, stability->distances);
}

bool stability_measure(Stability *stability, const Options *options, const char *povray, const char *folder)
{
    static const double gaps[MIRRORS] = {0.1, 1.0, 10.0}, shells[SHELLS] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-11, 1e-12};
    uint64_t cases = (uint64_t)options->cases, seed = SEED + (uint64_t)options->seed;
    *stability = (Stability){.family_count = 0};
    if (!measure_families(stability, cases, seed)) {
        return false;
    }
    for (int i = 0; i < SCALES; i++) {
        study_secondary(pow(10.0, 3 * (i - SCALES / 2)), cases, seed, &stability->secondary[i]);
    }
    for (int i = 0; i < MIRRORS; i++) {
        study_mirrors(gaps[i], &stability->mirrors[i]);
    }
    for (int i = 0; i < SHELLS; i++) {
        study_shells(shells[i], cases, seed, &stability->shells[i]);
    }
    study_total_reflection(cases, seed, &stability->total);
    study_malformed(&stability->malformed, stability->malformed_hits);
    return stability_pictures(stability, options, povray, folder);
}

void stability_fini(Stability *stability)
{
    for (size_t i = 0; i < stability->shown_count; i++) {
        for (int way = 0; way < SHOWN; way++) {
            image_fini(&stability->shown[i].in[way]);
        }
    }
    for (size_t i = 0; i < stability->break_count; i++) {
        image_fini(&stability->breaks[i].ours);
        image_fini(&stability->breaks[i].povray);
    }
    free(stability->breaks);
    free(stability->pictures);
}

// ---- the promise

// From the surface itself the root that is nearly 0 has a backward bound only.
static bool family_holds(const SphereRow *row)
{
    bool from_surface = strcmp(row->family, "leaving a surface") == 0;
    return row->of[FORMULA_OURS].wrong == 0 && row->of[FORMULA_OURS].not_finite == 0 &&
           row->of[FORMULA_OURS].backward <= 4.0 && (from_surface || row->of[FORMULA_OURS].ulps <= 4.0);
}

static bool secondary_holds(const SecondaryRow *row)
{
    return row->false_shadows[RULE_IDENTITY] == 0 && row->wrong_exits[RULE_IDENTITY] == 0 &&
           row->missed_contacts[RULE_IDENTITY] == 0;
}

static bool is_power_of_two(const PictureRow *row)
{
    return strncmp(row->what, "times 2^", 8) == 0;
}

// The other pictures have edges that rounding of the coordinates moves; docs/numerics.md tells how much.
static bool picture_holds(const PictureRow *row)
{
    return !is_power_of_two(row) || (row->is_made && row->is_same);
}

bool stability_holds(const Stability *stability)
{
    bool holds = stability->malformed_hits[FORMULA_OURS] == 0;
    for (size_t i = 0; i < stability->family_count; i++) {
        holds = holds && family_holds(&stability->families[i]);
    }
    for (int i = 0; i < SCALES; i++) {
        holds = holds && secondary_holds(&stability->secondary[i]);
    }
    for (int i = 0; i < SHELLS; i++) {
        holds = holds && stability->shells[i].wrong[FORMULA_OURS] == 0;
    }
    for (size_t i = 0; i < stability->picture_count; i++) {
        holds = holds && picture_holds(&stability->pictures[i]);
    }
    return holds;
}

// ---- text

static void print_families(const Stability *stability, FILE *out)
{
    fprintf(out,
            "A ray against a sphere, beside %s. eta: greatest backward error in u = 2^-53 of hits of the right class;\n"
            "ulps: greatest error of t; wrong: classes, those that no rounding excuses in brackets.\n\n",
            oracle_name());
    fprintf(out, "%-36s %9s  %-44s  %-44s\n", "", "", "textbook", "rtlang");
    fprintf(out, "%-36s %9s", "family", "cases");
    for (int formula = 0; formula < FORMULAS; formula++) {
        fprintf(out, "  %9s %9s %17s %6s", "eta", "ulps", "wrong", "no t");
    }
    fprintf(out, " %9s\n", "doubtful");
    for (size_t i = 0; i < stability->family_count; i++) {
        const SphereRow *row = &stability->families[i];
        // ± is one column and two bytes.
        int width = 36 + (strstr(row->family, "±") != NULL);
        fprintf(out, "%-*s %9" PRIu64, width, row->family, row->cases);
        for (int formula = 0; formula < FORMULAS; formula++) {
            char wrong[48];
            snprintf(wrong, sizeof wrong, "%" PRIu64 " (%" PRIu64 ")", row->of[formula].wrong,
                     row->of[formula].inexcusable);
            fprintf(out, "  %9.3g %9.3g %17s %6" PRIu64, row->of[formula].backward, row->of[formula].ulps, wrong,
                    row->of[formula].not_finite);
        }
        fprintf(out, " %9" PRIu64 "\n", row->doubtful);
    }
    fprintf(out,
            "\nOf %" PRIu64
            " rays and spheres with NaN, infinity, 0 and numbers out of range, hits whose t is no number: "
            "textbook %" PRIu64 ", rtlang %" PRIu64 ".\n",
            stability->malformed, stability->malformed_hits[FORMULA_TEXTBOOK], stability->malformed_hits[FORMULA_OURS]);
}

static double percent(uint64_t count, uint64_t cases)
{
    return cases ? 100.0 * (double)count / (double)cases : 0.0;
}

static void print_secondary(const Stability *stability, FILE *out)
{
    fprintf(out,
            "\nRays that start on a surface: false shadows under grazing light, wrong exits, missed contacts, in "
            "%%.\n\n%-10s",
            "scale");
    for (int rule = 0; rule < RULES; rule++) {
        fprintf(out, "  %-22s", study_rule_name((SecondaryRule)rule));
    }
    fputc('\n', out);
    for (int i = 0; i < SCALES; i++) {
        const SecondaryRow *row = &stability->secondary[i];
        fprintf(out, "%-10.0e", row->scale);
        for (int rule = 0; rule < RULES; rule++) {
            fprintf(out, "  %6.2f %6.2f %6.2f  ", percent(row->false_shadows[rule], row->cases),
                    percent(row->wrong_exits[rule], row->cases), percent(row->missed_contacts[rule], row->cases));
        }
        fputc('\n', out);
    }
}

static void print_stiff(const Stability *stability, FILE *out)
{
    fprintf(out,
            "\nTwo unit mirrors: bounces until a path along their axis is off by 1e-3, and what theory says.\n\n"
            "%6s %7s %16s %16s %16s\n",
            "gap", "growth", "float", "double", "quad");
    for (int i = 0; i < MIRRORS; i++) {
        const MirrorRow *row = &stability->mirrors[i];
        fprintf(out, "%6g %7.2f", row->gap, row->growth);
        for (int k = 0; k < 3; k++) {
            fprintf(out, " %6d (%6.1f)%s", row->bounces[k], row->theory[k], k < 2 ? " " : "\n");
        }
    }
    fprintf(out,
            "\nShells within one another: the inner one taken for the nearer, and both at the same t.\n\n%8s %10s %18s "
            "%18s\n",
            "gap", "cases", "textbook", "rtlang");
    for (int i = 0; i < SHELLS; i++) {
        const ShellRow *row = &stability->shells[i];
        fprintf(out, "%8.0e %10" PRIu64, row->gap, row->cases);
        for (int formula = 0; formula < FORMULAS; formula++) {
            fprintf(out, " %9" PRIu64 " %8" PRIu64, row->wrong[formula], row->ties[formula]);
        }
        fputc('\n', out);
    }
    const TotalRow *total = &stability->total;
    fprintf(out,
            "\nTotal reflection near its threshold: of %" PRIu64 " cases %" PRIu64
            " of the wrong class, all with |k| <= %.2g u; "
            "the bent ray's cosine is off by at most %.2g u / cos².\n",
            total->cases, total->wrong, total->greatest_wrong, total->cosine_error);
}

// A scene's name without its folders.
static const char *base_name(const char *scene)
{
    const char *slash = strrchr(scene, '/');
    return slash ? slash + 1 : scene;
}

static void print_pictures(const Stability *stability, FILE *out)
{
    fprintf(
        out,
        "\nPictures of 32 x 24 pixels. off: values that differ by more than 1e-6.\n\n%-34s %-26s %-9s %6s %6s %9s\n",
        "scene", "", "beside", "bits", "off", "RMSE");
    for (size_t i = 0; i < stability->picture_count; i++) {
        const PictureRow *row = &stability->pictures[i];
        fprintf(out, "%-34s %-26s %-9s ", base_name(row->scene), row->what, row->beside);
        if (row->is_made) {
            fprintf(out, "%6s %6" PRIu64 " %9.2g\n", row->is_same ? "same" : "differ", row->off, row->rmse);
        } else {
            fprintf(out, "not possible\n");
        }
    }
    fprintf(out,
            "\nWhere POV-Ray's range ends: pixels that differ by more than 2/255 from the same scene as it "
            "is.\n\n%-34s %-22s %8s %8s %8s\n",
            "scene", "", "pixels", "rtlang", "POV-Ray");
    for (size_t i = 0; i < stability->break_count; i++) {
        const BreakRow *row = &stability->breaks[i];
        fprintf(out, "%-34s %-22s %8" PRIu64 " %8" PRIu64, base_name(row->scene), row->what, row->pixels, row->off);
        row->has_povray ? fprintf(out, " %8" PRIu64 "\n", row->povray_off) : fprintf(out, " %8s\n", "none");
    }
}

void stability_print(const Stability *stability, FILE *out)
{
    print_families(stability, out);
    print_secondary(stability, out);
    print_stiff(stability, out);
    print_pictures(stability, out);
    fprintf(out, "\n%s\n",
            stability_holds(stability) ? "All that docs/numerics.md promises holds."
                                       : "Something that docs/numerics.md promises does not hold.");
}

// ---- JSON

static void json_formula(const SphereRow *row, int formula, FILE *out)
{
    fprintf(out,
            "\"%s\": {\"backward_error_u\": %.6g, \"ulps\": %.6g, \"wrong\": %" PRIu64 ", \"inexcusable\": %" PRIu64
            ", \"not_finite\": %" PRIu64 "}",
            study_formula_name((StudyFormula)formula), row->of[formula].backward, row->of[formula].ulps,
            row->of[formula].wrong, row->of[formula].inexcusable, row->of[formula].not_finite);
}

static void json_families(const Stability *stability, FILE *out)
{
    fprintf(out, "\"oracle\": \"%s\",\n\"families\": [", oracle_name());
    for (size_t i = 0; i < stability->family_count; i++) {
        const SphereRow *row = &stability->families[i];
        fprintf(out, "%s\n{\"family\": \"%s\", \"cases\": %" PRIu64 ", \"doubtful\": %" PRIu64 ", ", i > 0 ? "," : "",
                row->family, row->cases, row->doubtful);
        json_formula(row, FORMULA_TEXTBOOK, out);
        fprintf(out, ", ");
        json_formula(row, FORMULA_OURS, out);
        fprintf(out, "}");
    }
    fprintf(out,
            "],\n\"malformed\": {\"cases\": %" PRIu64 ", \"textbook\": %" PRIu64 ", \"rtlang\": %" PRIu64
            "},\n\"distances\": [",
            stability->malformed, stability->malformed_hits[0], stability->malformed_hits[1]);
    for (int i = 0; i < DISTANCE_POINTS; i++) {
        const DistancePoint *point = &stability->distances[i];
        fprintf(out, "%s\n{\"radii\": %.6g, \"textbook\": [%.6g, %.6g], \"rtlang\": [%.6g, %.6g]}", i > 0 ? "," : "",
                point->distance, point->backward[0], point->ulps[0], point->backward[1], point->ulps[1]);
    }
}

static void json_rays(const Stability *stability, FILE *out)
{
    fprintf(out, "],\n\"secondary\": [");
    for (int i = 0; i < SCALES; i++) {
        const SecondaryRow *row = &stability->secondary[i];
        fprintf(out, "%s\n{\"scale\": %.6g, \"cases\": %" PRIu64, i > 0 ? "," : "", row->scale, row->cases);
        for (int rule = 0; rule < RULES; rule++) {
            fprintf(out,
                    ", \"%s\": {\"false_shadows\": %" PRIu64 ", \"wrong_exits\": %" PRIu64
                    ", \"missed_contacts\": %" PRIu64 "}",
                    study_rule_name((SecondaryRule)rule), row->false_shadows[rule], row->wrong_exits[rule],
                    row->missed_contacts[rule]);
        }
        fprintf(out, "}");
    }
    fprintf(out, "],\n\"mirrors\": [");
    for (int i = 0; i < MIRRORS; i++) {
        const MirrorRow *row = &stability->mirrors[i];
        fprintf(out, "%s\n{\"gap\": %g, \"growth\": %.6g, \"bounces\": [%d, %d, %d], \"theory\": [%.6g, %.6g, %.6g]}",
                i > 0 ? "," : "", row->gap, row->growth, row->bounces[0], row->bounces[1], row->bounces[2],
                row->theory[0], row->theory[1], row->theory[2]);
    }
    fprintf(out, "],\n\"shells\": [");
    for (int i = 0; i < SHELLS; i++) {
        const ShellRow *row = &stability->shells[i];
        fprintf(out, "%s\n{\"gap\": %g, \"cases\": %" PRIu64 ", \"textbook\": %" PRIu64 ", \"rtlang\": %" PRIu64 "}",
                i > 0 ? "," : "", row->gap, row->cases, row->wrong[0], row->wrong[1]);
    }
    const TotalRow *total = &stability->total;
    fprintf(out,
            "],\n\"total_reflection\": {\"cases\": %" PRIu64 ", \"wrong\": %" PRIu64 ", \"greatest_wrong_u\": %.6g, "
            "\"cosine_error_u\": %.6g}",
            total->cases, total->wrong, total->greatest_wrong, total->cosine_error);
}

void stability_json(const Stability *stability, FILE *out)
{
    fprintf(out, "{\"type\": \"stability\", \"holds\": %s,\n", stability_holds(stability) ? "true" : "false");
    json_families(stability, out);
    json_rays(stability, out);
    fprintf(out, ",\n\"pictures\": [");
    for (size_t i = 0; i < stability->picture_count; i++) {
        const PictureRow *row = &stability->pictures[i];
        fprintf(out, "%s\n{\"scene\": ", i > 0 ? "," : "");
        json_print_text(out, row->scene);
        fprintf(out,
                ", \"what\": \"%s\", \"beside\": \"%s\", \"made\": %s, \"same_bits\": %s, \"values\": %" PRIu64
                ", \"off\": %" PRIu64 ", \"rmse\": %.6g}",
                row->what, row->beside, row->is_made ? "true" : "false", row->is_same ? "true" : "false", row->values,
                row->off, row->rmse);
    }
    fprintf(out, "],\n\"limits\": [");
    for (size_t i = 0; i < stability->break_count; i++) {
        const BreakRow *row = &stability->breaks[i];
        fprintf(out, "%s\n{\"scene\": ", i > 0 ? "," : "");
        json_print_text(out, row->scene);
        fprintf(out, ", \"what\": \"%s\", \"pixels\": %" PRIu64 ", \"rtlang\": %" PRIu64 ", \"povray\": ", row->what,
                row->pixels, row->off);
        row->has_povray ? fprintf(out, "%" PRIu64 "}", row->povray_off) : fprintf(out, "null}");
    }
    fprintf(out, "]}\n");
}
