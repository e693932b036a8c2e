// Outcomes as text for people and as JSON for programs.
//
// SPDX-License-Identifier: MIT
#include "check/report.h"

#include <inttypes.h>
#include <string.h>

#include "check/json.h"

double report_steps(double difference)
{
    return difference * 65535.0;
}

void report_text(FILE *out, const Outcome *outcome)
{
    const ImageDifference *d = &outcome->difference;

    if (!outcome->compared) {
        int length = (int)strlen(outcome->detail);
        while (length > 0 && outcome->detail[length - 1] == '\n') {
            length--;
        }
        fprintf(out, "%s: FAIL: %.*s\n", outcome->scene, length, outcome->detail);
        return;
    }
    fprintf(out, "%s: max %.0f, rmse %.3g, psnr %.1f dB, flip %.2g", outcome->scene, report_steps(d->max),
            report_steps(d->rmse), d->psnr, outcome->flip);
    fprintf(out, ", beyond %" PRIu64 " (%.4f %%), beyond 1/65535 %" PRIu64 ", beyond 1/255 %" PRIu64,
            d->pixels_beyond[BEYOND_THRESHOLD], 100.0 * (double)d->pixels_beyond[BEYOND_THRESHOLD] / (double)d->pixels,
            d->pixels_beyond[BEYOND_CODE_16], d->pixels_beyond[BEYOND_CODE_8]);
    if (outcome->decided_by_rounding > 0) {
        fprintf(out, ", %" PRIu64 " by rounding", outcome->decided_by_rounding);
    }
    if (outcome->povray_elsewhere > 0) {
        fprintf(out, ", %" PRIu64 " not elsewhere", outcome->povray_elsewhere);
    }
    if (outcome->larger >= 0) {
        fprintf(out, ", %" PRId64 " where it is larger", outcome->larger);
    }
    fprintf(out, ", rtlang %.3f s, povray %.3f s (%.1fx)%s%s: %s\n", outcome->rtlang_seconds, outcome->povray_seconds,
            outcome->povray_seconds / outcome->rtlang_seconds, outcome->range[0] != '\0' ? ", " : "", outcome->range,
            outcome->agrees ? "ok" : "FAIL");
}

void report_json(FILE *out, const Outcome *outcome)
{
    const ImageDifference *d = &outcome->difference;

    fprintf(out, "{\"scene\": ");
    json_print_text(out, outcome->scene);
    fprintf(out, ", \"agrees\": %s", outcome->agrees ? "true" : "false");
    if (outcome->compared) {
        json_print_number(out, "max", report_steps(d->max));
        json_print_number(out, "rmse", report_steps(d->rmse));
        json_print_number(out, "p999", report_steps(d->p999));
        json_print_number(out, "psnr", d->psnr);
        json_print_number(out, "flip", outcome->flip);
        fprintf(out, ", \"beyond\": %" PRIu64 ", \"beyond_code_16\": %" PRIu64 ", \"beyond_code_8\": %" PRIu64,
                d->pixels_beyond[BEYOND_THRESHOLD], d->pixels_beyond[BEYOND_CODE_16], d->pixels_beyond[BEYOND_CODE_8]);
        fprintf(out, ", \"by_rounding\": %" PRIu64 ", \"not_elsewhere\": %" PRIu64, outcome->decided_by_rounding,
                outcome->povray_elsewhere);
        if (outcome->larger >= 0) {
            fprintf(out, ", \"larger\": %" PRId64, outcome->larger);
        }
        fprintf(out, ", \"pixels\": %" PRIu64, d->pixels);
        json_print_number(out, "rtlang_seconds", outcome->rtlang_seconds);
        json_print_number(out, "povray_seconds", outcome->povray_seconds);
        json_print_number(out, "ratio", outcome->povray_seconds / outcome->rtlang_seconds);
    } else {
        fprintf(out, ", \"fault\": ");
        json_print_text(out, outcome->detail);
    }
    if (outcome->range[0] != '\0') {
        fprintf(out, ", \"range\": ");
        json_print_text(out, outcome->range);
    }
    fputc('}', out);
}
