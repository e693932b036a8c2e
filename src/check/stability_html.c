// The section on stability of the HTML report: tables, a plot of error against distance, and POV-Ray's limits.
//
// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "check/stability.h"
#include "study/oracle.h"

static void head(FILE *out, const char *name, const char *const *titles)
{
    report_table_heading(out, name);
    for (; *titles; titles++) {
        fputs("<th scope=\"col\">", out);
        html_text(out, *titles);
        fputs("</th>", out);
    }
    report_table_rows(out);
}

static void cell_number(FILE *out, double value, double bar)
{
    const char *verdict = isinf(bar) ? "" : value <= bar ? " good" : " bad"; // infinite: nothing is promised
    fprintf(out, "<td class=\"number%s\">%.3g</td>", verdict, value);
}

// The answer that was computed is the exact answer to a question nearby: how near, is the backward error.
static void put_backward(FILE *out)
{
    fputs("<figure class=\"drawn\"><svg class=\"backward\" viewBox=\"0 0 440 230\" role=\"img\" aria-label=\"A ray and a sphere "
          "as given, and the sphere nearby on which the computed point lies exactly\">\n"
          "<line class=\"ray\" x1=\"10\" y1=\"104\" x2=\"425\" y2=\"104\"/>"
          "<circle class=\"given\" cx=\"300\" cy=\"120\" r=\"80\"/><circle class=\"nearby\" cx=\"300\" cy=\"120\" r=\"98\"/>"
          "<circle class=\"exact\" cx=\"221.6\" cy=\"104\" r=\"4\"/><circle class=\"computed\" cx=\"203.3\" cy=\"104\" r=\"4\"/>"
          "<line class=\"off\" x1=\"300\" y1=\"200\" x2=\"300\" y2=\"218\"/>"
          "<text x=\"12\" y=\"96\">the ray, as given</text><text x=\"300\" y=\"142\" text-anchor=\"middle\">the sphere,</text>"
          "<text x=\"300\" y=\"158\" text-anchor=\"middle\">as given</text>"
          "<text x=\"60\" y=\"30\">nearby: the computed</text><text x=\"60\" y=\"46\">point is exact here</text>"
          "<text x=\"228\" y=\"98\">exact point</text><text x=\"88\" y=\"124\">computed point</text></svg>\n"
          "<figcaption>Every computed point lies exactly on some sphere nearby, here far enough off to be seen. The backward "
          "error is how far that one is from the sphere that was given, beside what rounding of the input moves it anyway: "
          "1 u is no more than writing the numbers down, and a great error means that another scene was drawn.</figcaption>"
          "</figure>\n",
          out);
}

static void put_families(const Stability *stability, FILE *out)
{
    static const char *const titles[] = {"Family",
                                         "Cases",
                                         "Textbook: backward error, u",
                                         "Textbook: t, ulps",
                                         "Textbook: wrong classes",
                                         "Textbook: no t",
                                         "rtlang: backward error, u",
                                         "rtlang: t, ulps",
                                         "rtlang: wrong classes",
                                         "rtlang: no t",
                                         "By double words",
                                         NULL};
    fputs("<h3>Formulas on hard rays</h3>\n<p>A ray against a sphere in families of hard cases, beside exact arithmetic (", out);
    html_text(out, oracle_name());
    fputs("), in units of u = 2<sup>-53</sup>. The class is miss, near or far root.</p>\n", out);
    put_backward(out);
    head(out, "Formulas", titles);
    for (size_t i = 0; i < stability->family_count; i++) {
        const SphereRow *row = &stability->families[i];
        fputs("<tr><td>", out);
        html_text(out, row->family);
        fprintf(out, "</td><td class=\"number\">%" PRIu64 "</td>", row->cases);
        for (int formula = 0; formula < FORMULAS; formula++) {
            // From the surface itself the root that is nearly 0 has a backward bound only.
            bool from_surface = strcmp(row->family, "leaving a surface") == 0;
            cell_number(out, row->of[formula].backward, 4.0);
            cell_number(out, row->of[formula].ulps, from_surface ? (double)INFINITY : 4.0);
            cell_number(out, (double)row->of[formula].wrong, 0.0);
            cell_number(out, (double)row->of[formula].not_finite, 0.0);
        }
        fprintf(out, "<td class=\"number\">%" PRIu64 "</td></tr>\n", row->doubtful);
    }
    report_table_close(out);
}

// ---- the plot: decades of error over decades of distance

enum { LEFT = 60, TOP = 12, PLOT_WIDTH = 560, PLOT_HEIGHT = 260, DECADES_ACROSS = 15, DECADES_UP = 18 };

static double across(double distance)
{
    return LEFT + PLOT_WIDTH * log10(distance) / DECADES_ACROSS;
}

// From 1e-2 u up.
static double up(double error)
{
    double decades = fmin(fmax(log10(error) + 2.0, 0.0), DECADES_UP);
    return TOP + PLOT_HEIGHT * (1.0 - decades / DECADES_UP);
}

static void put_curve(const Stability *stability, bool is_ulps, int formula, const char *style, FILE *out)
{
    fputs("<path fill=\"none\" ", out);
    fprintf(out, "style=\"%s\" d=\"", style);
    for (int i = 0; i < DISTANCE_POINTS; i++) {
        const DistancePoint *point = &stability->distances[i];
        double error = is_ulps ? point->ulps[formula] : point->backward[formula];
        fprintf(out, "%c%.1f %.1f", i > 0 ? 'L' : 'M', across(point->distance), up(error));
    }
    fputs("\"/>\n", out);
}

static void put_plot(const Stability *stability, FILE *out)
{
    fprintf(out,
            "<h3>Error against distance</h3>\n<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" "
            "aria-label=\"Greatest errors of the textbook's formula and of rtlang's against the distance in radii\">\n",
            LEFT + PLOT_WIDTH + 20, TOP + PLOT_HEIGHT + 44);
    for (int decade = 0; decade <= DECADES_ACROSS; decade += 3) {
        double x = across(pow(10.0, decade));
        fprintf(out,
                "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\"/><text x=\"%.1f\" y=\"%d\" "
                "text-anchor=\"middle\">1e%d</text>\n",
                x, TOP, x, TOP + PLOT_HEIGHT, x, TOP + PLOT_HEIGHT + 16, decade);
    }
    for (int decade = -2; decade <= DECADES_UP - 2; decade += 3) {
        double y = up(pow(10.0, decade));
        fprintf(out,
                "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\"/><text x=\"%d\" y=\"%.1f\" "
                "text-anchor=\"end\">1e%d</text>\n",
                LEFT, y, LEFT + PLOT_WIDTH, y, LEFT - 6, y + 4.0, decade);
    }
    put_curve(stability, false, FORMULA_TEXTBOOK, "stroke:var(--bad);stroke-width:2", out);
    put_curve(stability, true, FORMULA_TEXTBOOK, "stroke:var(--bad);stroke-width:2;stroke-dasharray:5 4", out);
    put_curve(stability, false, FORMULA_OURS, "stroke:var(--good);stroke-width:2", out);
    put_curve(stability, true, FORMULA_OURS, "stroke:var(--good);stroke-width:2;stroke-dasharray:5 4", out);
    fprintf(out, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">distance / radius</text></svg>\n",
            LEFT + PLOT_WIDTH / 2, TOP + PLOT_HEIGHT + 36);
    fputs("<p class=\"faint\"><span class=\"bad\">Textbook</span> and <span class=\"good\">rtlang</span>: backward "
          "error in u (whole line) "
          "and error of t in ulps (dashed), the greatest of some hundred rays at each distance.</p>\n",
          out);
}

static void put_secondary(const Stability *stability, FILE *out)
{
    static const char *const titles[] = {"Scale",
                                         "None: false shadows",
                                         "None: wrong exits",
                                         "None: missed contacts",
                                         "t > 0.001: false shadows",
                                         "t > 0.001: wrong exits",
                                         "t > 0.001: missed contacts",
                                         "rtlang: false shadows",
                                         "rtlang: wrong exits",
                                         "rtlang: missed contacts",
                                         NULL};
    fputs("<h3>Rays that start on a surface, in %</h3>\n", out);
    head(out, "Rays that start on a surface", titles);
    for (int i = 0; i < SCALES; i++) {
        const SecondaryRow *row = &stability->secondary[i];
        fprintf(out, "<tr><td class=\"number\">%.0e</td>", row->scale);
        for (int rule = 0; rule < RULES; rule++) {
            cell_number(out, 100.0 * (double)row->false_shadows[rule] / (double)row->cases, 0.0);
            cell_number(out, 100.0 * (double)row->wrong_exits[rule] / (double)row->cases, 0.0);
            cell_number(out, 100.0 * (double)row->missed_contacts[rule] / (double)row->cases, 0.0);
        }
        fputs("</tr>\n", out);
    }
    report_table_close(out);
}

static void put_mirrors(const Stability *stability, FILE *out)
{
    static const char *const titles[] = {"Gap",  "Growth a bounce", "float", "theory", "double", "theory",
                                         "quad", "theory",          NULL};
    fputs("<h3>Two unit mirrors: bounces until the path is lost</h3>\n", out);
    head(out, "Mirrors", titles);
    for (int i = 0; i < MIRRORS; i++) {
        const MirrorRow *row = &stability->mirrors[i];
        fprintf(out, "<tr><td class=\"number\">%g</td><td class=\"number\">%.2f</td>", row->gap, row->growth);
        for (int k = 0; k < 3; k++) {
            fprintf(out, "<td class=\"number\">%d</td><td class=\"number\">%.1f</td>", row->bounces[k], row->theory[k]);
        }
        fputs("</tr>\n", out);
    }
    report_table_close(out);
}

static void put_shells(const Stability *stability, FILE *out)
{
    static const char *const titles[] = {"Gap", "Cases", "Textbook: wrong order", "Textbook: same t",
                                         "rtlang: wrong order", "rtlang: same t", NULL};
    const TotalRow *total = &stability->total;
    fputs("<h3>Shells within one another</h3>\n", out);
    head(out, "Shells", titles);
    for (int i = 0; i < SHELLS; i++) {
        const ShellRow *row = &stability->shells[i];
        fprintf(out, "<tr><td class=\"number\">%.0e</td><td class=\"number\">%" PRIu64 "</td>", row->gap, row->cases);
        for (int formula = 0; formula < FORMULAS; formula++) {
            cell_number(out, (double)row->wrong[formula], 0.0);
            fprintf(out, "<td class=\"number\">%" PRIu64 "</td>", row->ties[formula]);
        }
        fputs("</tr>\n", out);
    }
    report_table_close(out);
    fprintf(out,
            "<h3>Total reflection near its threshold</h3>\n<p>Of %" PRIu64 " cases %" PRIu64
            " of the wrong class, all with |k| &le; %.2g u of 4.3 u; the bent ray's cosine is off by at most %.2g u of "
            "4.8 u "
            "over cos<sup>2</sup>.</p>\n",
            total->cases, total->wrong, total->greatest_wrong, total->cosine_error);
}

static void put_pictures(const Stability *stability, FILE *out)
{
    static const char *const titles[] = {"Scene", "Put", "Beside", "Bits", "Values off by 1e-6", "RMSE", NULL};
    fputs("<h3>Pictures put elsewhere</h3>\n", out);
    head(out, "Pictures put elsewhere", titles);
    for (size_t i = 0; i < stability->picture_count; i++) {
        const PictureRow *row = &stability->pictures[i];
        fputs("<tr><td>", out);
        html_text(out, row->scene);
        fputs("</td><td>", out);
        html_text(out, row->what);
        fprintf(out, "</td><td>%s</td>", row->beside);
        if (row->is_made) {
            fprintf(out,
                    "<td class=\"%s\">%s</td><td class=\"number\">%" PRIu64
                    "</td><td class=\"number\">%.2g</td></tr>\n",
                    row->is_same ? "good" : "", row->is_same ? "same" : "differ", row->off, row->rmse);
        } else {
            fputs("<td>not possible</td><td></td><td></td></tr>\n", out);
        }
    }
    report_table_close(out);
}

static bool put_picture(const Image *image, const char *caption, FILE *out)
{
    static const ImageEncoding encoding = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_SRGB};
    fputs("<figure><img alt=\"", out);
    html_text(out, caption);
    fputs("\" src=\"", out);
    bool fine = html_picture(out, image, &encoding);
    fprintf(out, "\"><figcaption>%s</figcaption></figure>\n", caption);
    return fine;
}

static bool put_shown(const Stability *stability, FILE *out)
{
    static const char *const captions[SHOWN] = {
        [SHOWN_FLOAT] = "float", [SHOWN_DOUBLE] = "double", [SHOWN_QUAD] = "quad", [SHOWN_POVRAY] = "POV-Ray"};
    bool fine = true;
    fputs("<h3>Stiff scenes</h3>\n", out);
    for (size_t i = 0; i < stability->shown_count; i++) {
        const ShownRow *row = &stability->shown[i];
        fprintf(out, "<article><h3>%s</h3><div class=\"pictures four\">\n", row->scene);
        for (int way = 0; way < SHOWN; way++) {
            if (row->has[way]) {
                fine = put_picture(&row->in[way], captions[way], out) && fine;
            } else {
                fprintf(out, "<p class=\"bad\">No picture: %s.</p>\n", captions[way]);
            }
        }
        fputs("</div></article>\n", out);
    }
    return fine;
}

// Whether more than one pixel in a thousand is another than that of the scene as it is.
static bool is_off(uint64_t off, uint64_t pixels)
{
    return off * 1000 > pixels;
}

static bool is_povray_off(const BreakRow *row)
{
    return !row->has_povray || is_off(row->povray_off, row->pixels);
}

static bool is_other(const BreakRow *row)
{
    return is_off(row->off, row->pixels) || is_povray_off(row);
}

// Of how many pictures that holds.
static void put_breaks_sum(const Stability *stability, FILE *out)
{
    size_t ours = 0, theirs = 0;

    if (stability->break_count == 0) {
        fputs("<p>No scene was given: rtcheck --stability SCENE… draws them.</p>\n", out);
        return;
    }
    for (size_t i = 0; i < stability->break_count; i++) {
        const BreakRow *row = &stability->breaks[i];
        ours += is_off(row->off, row->pixels);
        theirs += is_povray_off(row);
    }
    fprintf(out,
            "<p class=\"verdict\">Of %zu pictures of scenes put elsewhere, POV-Ray draws %zu otherwise or not at all, rtlang "
            "%zu.</p>\n",
            stability->break_count, theirs, ours);
}

// Both pictures of a scene put elsewhere.
static bool put_break(const BreakRow *row, FILE *out)
{
    char caption[128];
    fputs("<article><h4>", out);
    html_text(out, row->scene);
    fprintf(out, ", %s</h4><div class=\"pictures\">\n", row->what);
    snprintf(caption, sizeof caption, "rtlang: %" PRIu64 " of %" PRIu64 " pixels differ", row->off, row->pixels);
    bool fine = put_picture(&row->ours, caption, out);
    if (row->has_povray) {
        snprintf(caption, sizeof caption, "POV-Ray: %" PRIu64 " of %" PRIu64 " pixels differ", row->povray_off,
                 row->pixels);
        fine = put_picture(&row->povray, caption, out) && fine;
    } else {
        fputs("<p class=\"bad\">POV-Ray makes no picture of it.</p>\n", out);
    }
    fputs("</div></article>\n", out);
    return fine;
}

// What one of the programs draws otherwise comes first; what both draw alike waits to be asked for.
static bool put_breaks(const Stability *stability, FILE *out)
{
    bool fine = true;
    put_breaks_sum(stability, out);
    fputs("<h3>Where POV-Ray's range ends</h3>\n<p>The same scenes in other units and places. Pixels are counted that "
          "differ by more than 2/255 from the scene as it is. A shift by 1e6 is still within that range.</p>\n"
          "<div class=\"cards\">\n",
          out);
    for (size_t i = 0; i < stability->break_count; i++) {
        if (is_other(&stability->breaks[i])) {
            fine = put_break(&stability->breaks[i], out) && fine;
        }
    }
    fputs("</div>\n<details><summary>The scene as it is, and where both programs draw it so</summary>"
          "<div class=\"cards\">\n",
          out);
    for (size_t i = 0; i < stability->break_count; i++) {
        if (!is_other(&stability->breaks[i])) {
            fine = put_break(&stability->breaks[i], out) && fine;
        }
    }
    fputs("</div></details>\n", out);
    return fine;
}

bool stability_page(const Stability *stability, ReportPage *page)
{
    FILE *out = report_page_section(page, "stability", "Numerical stability");
    fprintf(out, "<p>%s</p>\n",
            stability_holds(stability) ? "All that docs/numerics.md promises holds."
                                       : "Something that docs/numerics.md promises does not hold.");
    bool fine = put_breaks(stability, out);
    put_families(stability, out);
    put_plot(stability, out);
    put_secondary(stability, out);
    put_mirrors(stability, out);
    put_shells(stability, out);
    fine = put_shown(stability, out) && fine;
    put_pictures(stability, out);
    return fine && !ferror(out);
}
