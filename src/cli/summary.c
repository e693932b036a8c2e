// The lines at the end of a run.
//
// SPDX-License-Identifier: MIT
#include "cli/summary.h"

#include <string.h>

const char *summary_bias_cause(const rt_error *error)
{
    return error->bias_by_level > 0.5 * error->bias ? "max_trace_level" : "adc_bailout";
}

void summary_print(FILE *out, const rt_session *session, const char *output)
{
    rt_summary s;
    bool is_stream = output[0] == '-' && (output[1] == '\0' || output[1] == '.');
    rt_get_summary(session, &s);
    char warnings[128] = "", beyond[64] = "";
    if (s.out_of_range > 0) {
        snprintf(beyond, sizeof beyond, ", %llu of them of the range of numbers", (unsigned long long)s.out_of_range);
    }
    if (s.warnings > 0) {
        snprintf(warnings, sizeof warnings, "; %llu warning%s%s", (unsigned long long)s.warnings,
                 s.warnings == 1 ? "" : "s", beyond);
    }
    fprintf(out,
            "%s: %dx%d, %llu object%s, %llu light%s; rays: %llu camera, %llu shadow, %llu reflected, %llu transmitted; "
            "seconds: parse %.3f, prepare %.3f, trace %.3f, write %.3f%s\n",
            is_stream ? "standard output" : output, s.width, s.height, (unsigned long long)s.objects,
            s.objects == 1 ? "" : "s", (unsigned long long)s.lights, s.lights == 1 ? "" : "s",
            (unsigned long long)s.camera_rays, (unsigned long long)s.shadow_rays, (unsigned long long)s.reflected_rays,
            (unsigned long long)s.transmitted_rays, s.parse_seconds, s.prepare_seconds, s.trace_seconds,
            s.write_seconds, warnings);
}

// "3 shapes of 0.02 pixels in all"; nothing for none. Returns how many.
static double put_unmet(char text[64], const char *word, double count, double area, bool is_about)
{
    char size[16];
    snprintf(size, sizeof size, "%.2g", area);
    text[0] = 0;
    if (count > 0.0) {
        snprintf(text, 64, "%s%.0f %s%s of %s pixel%s%s", is_about ? "about " : "", count, word,
                 count == 1.0 ? "" : "s", size, strcmp(size, "1") == 0 ? "" : "s", count == 1.0 ? "" : " in all");
    }
    return count;
}

// What no sample met, as the end of a line.
static void print_unmet(FILE *out, const rt_error *error)
{
    char shapes[64], highlights[64];
    double count = put_unmet(shapes, "shape", error->unmet_shapes, error->unmet_shape_area, error->unmet_are_about) +
                   put_unmet(highlights, "highlight", error->unmet_highlights, error->unmet_highlight_area,
                             error->unmet_are_about);
    if (count > 0.0) {
        fprintf(out, "; %s%s%s %s met by no sample", shapes, *shapes && *highlights ? " and " : "", highlights,
                count == 1.0 ? "was" : "were");
    }
}

// The error of a sampled picture, and why there is no less.
void summary_print_error(FILE *out, const rt_session *session, const Options *options)
{
    static const char *const ends[] = {[RT_END_DONE] = "", [RT_END_TARGET] = "; the target is reached",
                                       [RT_END_TIME] = "; the time is over",
                                       [RT_END_INTERRUPTED] = "; interrupted"};
    rt_error error;
    rt_get_error(session, &error);
    if (!error.known) {
        return;
    }
    fprintf(out, "error: rmse %.3g, with 95 %% confidence %.3g to %.3g, at %.17g %s a pixel%s%s", error.rmse,
            error.low, error.high, error.samples, options->method != RT_METHOD_BACKWARD ? "photons" : "samples",
            options->sampling.target_error > 0.0 && error.end != RT_END_TARGET ? "; the target is not reached" : "",
            ends[error.end]);
    print_unmet(out, &error);
    fputc('\n', out);
    if (options->method != RT_METHOD_BACKWARD) {
        rt_photons photons;
        rt_get_photons(session, &photons);
        fprintf(out, "photons: %llu, of which %llu met a surface; %llu arrivals on the film, one for %.3g photons\n",
                (unsigned long long)photons.emitted, (unsigned long long)photons.met,
                (unsigned long long)photons.arrived, (double)photons.emitted / (double)photons.arrived);
    }
    // Reported where it alone could be more than all of the error that is known.
    if (error.missed_error > error.high) {
        fprintf(out, "missed: a detail of up to %.2g pixel%s may be in no sample, and would add up to %.2g\n",
                error.missed_area, error.missed_area == 1.0 ? "" : "s", error.missed_error);
    }
    if (error.bias > 0.0) {
        fprintf(out, "bias: rays cut by %s would add about %.2g in the mean%s\n", summary_bias_cause(&error),
                error.bias, error.bias > error.high ? "; more samples will not help" : "");
    }
}

unsigned long long summary_trees(const rt_session *session)
{
    rt_summary summary;
    rt_get_summary(session, &summary);
    return summary.trees;
}

void summary_print_frames(Voice *voice, const FrameCounts *counts)
{
    char text[160], there[48] = "";
    if (counts->there > 0) {
        snprintf(there, sizeof there, ", %llu there already", counts->there);
    }
    int length = snprintf(text, sizeof text, "animation: %llu frame%s drawn%s; the scene read %llu time%s, its tree built %llu time%s\n",
                          counts->drawn, counts->drawn == 1 ? "" : "s", there, counts->reads,
                          counts->reads == 1 ? "" : "s", counts->trees, counts->trees == 1 ? "" : "s");
    voice_say(voice, VOICE_STATISTICS, text, (size_t)length);
}
