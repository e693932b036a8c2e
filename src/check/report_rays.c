// Chooses the pixels whose rays are logged, and prints the viewer's frame, the logs and the source.
//
// SPDX-License-Identifier: MIT
#include "check/report_rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/report.h"
#include "check/report_about.h"
#include "check/report_html.h"

enum {
    RAYS = 6,       // pixels whose rays are logged
    RAYS_APART = 8, // pixels between them at least
    DIGITS = 6,
    LOG_MOST = 20000, // bytes of a log
    SOURCE_MOST = 200000,
};

typedef struct Pixel {
    int x, y;
    double difference;
} Pixel;

// Whether one that was chosen already lies near.
static bool is_near(const Pixel *pixels, int count, int x, int y)
{
    for (int i = 0; i < count; i++) {
        if (abs(pixels[i].x - x) < RAYS_APART && abs(pixels[i].y - y) < RAYS_APART) {
            return true;
        }
    }
    return false;
}

// Those that differ most, not next to one another; the middle of the picture where none differs.
static int pixels_choose(const Image *ours, const Image *theirs, Pixel pixels[RAYS])
{
    int count = 0;

    for (bool is_found = true; is_found && count < RAYS;) {
        Pixel most = {.difference = 0.0};
        for (int y = 0; y < ours->height; y++) {
            for (int x = 0; x < ours->width; x++) {
                double difference = image_pixel_difference(ours, theirs, (size_t)y * (size_t)ours->width + (size_t)x);
                if (difference > most.difference && !is_near(pixels, count, x, y)) {
                    most = (Pixel){x, y, difference};
                }
            }
        }
        is_found = most.difference > 0.0;
        if (is_found) {
            pixels[count++] = most;
        }
    }
    if (count == 0) {
        pixels[count++] = (Pixel){ours->width / 2, ours->height / 2, 0.0};
    }
    return count;
}

// The drawing within the page needs no name of its kind.
static void print_drawing(FILE *out, const char *svg)
{
    static const char name[] = " xmlns=\"http://www.w3.org/2000/svg\"";
    const char *at = strstr(svg, name);

    if (at) {
        fwrite(svg, 1, (size_t)(at - svg), out);
        fputs(at + strlen(name), out);
    }
}

static void print_log(FILE *out, const char *text)
{
    size_t length = strlen(text);
    char *copy = strndup(text, LOG_MOST);

    if (copy) {
        fputs("<pre tabindex=\"0\">", out);
        html_text(out, copy);
        fprintf(out, "%s</pre>\n", length > LOG_MOST ? "\n… the rest is long" : "");
    }
    free(copy);
}

static void print_pixel(FILE *out, int number, rt_session *session, const Pixel *pixel)
{
    const char *text;

    fprintf(out,
            "<details class=\"ray\" id=\"ray-%d-%d-%d\" data-x=\"%d\" data-y=\"%d\"><summary>pixel %d, %d: %.0f/65535 "
            "apart</summary>\n",
            number, pixel->x, pixel->y, pixel->x, pixel->y, pixel->x, pixel->y, report_steps(pixel->difference));
    if (rt_set_trace_form(session, RT_TRACE_SVG, DIGITS) == RT_OK &&
        rt_trace_pixel(session, pixel->x, pixel->y, &text) == RT_OK) {
        print_drawing(out, text);
    }
    if (rt_set_trace_form(session, RT_TRACE_LOG, DIGITS) == RT_OK &&
        rt_trace_pixel(session, pixel->x, pixel->y, &text) == RT_OK) {
        print_log(out, text);
    }
    fputs("</details>\n", out);
}

// The command that logs a pixel's ray, whose place the page puts in.
static void print_command(FILE *out, const char *scene, const Options *options)
{
    fprintf(out, "rtlang -W%d -H%d ", options->width, options->height);
    for (int i = 0; i < options->include_path_count; i++) {
        fputs("-I ", out);
        report_word(out, options->include_paths[i]);
        fputc(' ', out);
    }
    if (options->clock_given) {
        fprintf(out, "--clock=%.17g ", options->clock);
    }
    fputs("--trace-pixel=X,Y ", out);
    report_word(out, scene);
}

static void print_viewer(FILE *out, int number, const char *scene, const Options *options)
{
    fputs("<details class=\"viewer\"><summary>Flicker, zoom, and the ray of a pixel</summary>\n<div class=\"tools\">",
          out);
    fputs("<label>Show <select class=\"shown\"><option value=\"0\">rtlang</option><option value=\"1\">POV-Ray</option>"
          "<option value=\"2\">the difference</option></select></label>"
          "<button type=\"button\" class=\"flicker\" aria-pressed=\"false\">Flicker</button>"
          "<label>Zoom <select class=\"zoom\">",
          out);
    for (int zoom = 1; zoom <= 16; zoom *= 2) {
        fprintf(out, "<option value=\"%d\"%s>%d times</option>", zoom, zoom == 2 ? " selected" : "", zoom);
    }
    fprintf(out,
            "</select></label></div>\n<div class=\"stage\" tabindex=\"0\" role=\"region\" aria-label=\"Picture %d, "
            "enlarged: a click on a pixel shows its ray\"></div>\n<output class=\"pixel\">A click on a pixel shows "
            "its ray.</output>\n<code class=\"command\" data-command=\"",
            number);
    print_command(out, scene, options);
    fputs("\"></code>\n</details>\n", out);
}

// With the numbers of its lines, as messages and logs have them.
static void print_source(FILE *out, const char *scene)
{
    FILE *in = fopen(scene, "rb");
    int line = 1, count = 0, c = EOF;

    fputs("<details class=\"source\"><summary>The scene's text</summary>\n<pre tabindex=\"0\">", out);
    for (bool is_start = true; in && count < SOURCE_MOST && (c = fgetc(in)) != EOF; count++) {
        if (is_start) {
            fprintf(out, "%5d  ", line++);
        }
        is_start = c == '\n';
        if (c != '\0' && c != '\r') {
            html_text(out, (char[]){(char)c, '\0'});
        }
    }
    fprintf(out, "%s</pre></details>\n", in && c != EOF ? "\n… the rest is long" : "");
    if (in) {
        fclose(in);
    }
}

void report_rays(FILE *out, const ComparedScene *compared, const Options *options)
{
    Pixel pixels[RAYS];
    int count = pixels_choose(compared->ours, compared->theirs, pixels);

    print_viewer(out, compared->number, compared->scene, options);
    fputs("<div class=\"rays\">\n", out);
    for (int i = 0; i < count; i++) {
        print_pixel(out, compared->number, compared->session, &pixels[i]);
    }
    fputs("</div>\n", out);
    print_source(out, compared->scene);
}
