// The pictures of a scene: each file that something seen uses is read once, and its values brought to the working
// space.
//
// Turns what a file holds into what the renderer looks up. Reports at the place where the file is named. Knows nothing
// of how pictures are laid, except which palettes they may count on.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "image/picture_file.h"

// What a value of a file, 0 to 1 or beyond in float, becomes: decoded to light, then encoded as the working space is.
typedef struct Way {
    bool is_kept;        // it is taken as it is
    bool from_srgb;
    double from_gamma;   // unless from_srgb
    GammaModel to;       // GAMMA_NONE and GAMMA_LINEAR: light itself
    double to_gamma;
} Way;

// Formats that say nothing of gamma themselves hold sRGB, numbers of the working space, or light.
static bool holds_light(PictureFormat format)
{
    return format == PICTURE_EXR || format == PICTURE_HDR;
}

static bool holds_srgb(PictureFormat format)
{
    return format == PICTURE_PNG || format == PICTURE_JPEG || format == PICTURE_TGA;
}

// As POV-Ray 3.7 decides, measured: docs/language.md, "Pictures".
static Way way_choose(const PictureSource *source, const PictureFile *file)
{
    PictureFormat format = (PictureFormat)source->format;
    Way way = {.from_gamma = 1.0, .to = (GammaModel)source->space, .to_gamma = source->space_gamma};
    bool has_space = way.to != GAMMA_NONE;
    if (source->encoding != PICTURE_GAMMA_UNSAID) {
        way.from_srgb = source->encoding == PICTURE_GAMMA_SRGB;
        way.from_gamma = source->gamma;
    } else if (has_space && file->has_gamma) {
        way.from_srgb = file->gamma == 0.0;
        way.from_gamma = file->gamma;
    } else if (has_space && source->is_modern && holds_srgb(format)) {
        way.from_srgb = true;
    } else {
        way.is_kept = !(has_space && holds_light(format));
    }
    return way;
}

static double way_go(const Way *way, double value)
{
    if (way->is_kept) {
        return value;
    }
    double light = way->from_srgb ? rgb_srgb_decode(value) : pow(fmax(value, 0.0), way->from_gamma);
    if (way->to == GAMMA_SRGB) {
        return rgb_srgb_encode(light);
    }
    return way->to == GAMMA_POWER ? pow(light, 1.0 / way->to_gamma) : light;
}

// POV-Ray keeps a grey PNG picture of up to 8 bits without alpha in 8 bits of the working space, rounded down, after it
// has added up its three equal colours in single precision. Measured for all 256 codes.
static float grey_of(double value)
{
    float single = (float)value;
    float sum = 0.297F * single + 0.589F * single + 0.114F * single;
    return floorf(sum * 255.0F) / 255.0F;
}

// ---- from the file to the scene

static bool make_table(Picture *picture, const Way *way, bool is_coarse)
{
    size_t codes = picture->depth == PICTURE_DEPTH_8 ? 256 : 65536;
    picture->decoded = malloc(codes * sizeof *picture->decoded);
    for (size_t i = 0; picture->decoded && i < codes; i++) {
        double value = way_go(way, (double)i / (double)(codes - 1));
        picture->decoded[i] = is_coarse ? grey_of(value) : (float)value;
    }
    return picture->decoded != NULL;
}

static bool make_palette(Picture *picture, const PictureFile *file, const Way *way)
{
    picture->palette = calloc(PICTURE_PALETTE, sizeof *picture->palette);
    for (int i = 0; picture->palette && i < file->palette_count; i++) {
        const uint8_t *codes = file->palette[i];
        picture->palette[i] =
            (PictureColour){(float)way_go(way, codes[0] / 255.0), (float)way_go(way, codes[1] / 255.0),
                            (float)way_go(way, codes[2] / 255.0), 0.0F, 1.0F - (float)codes[3] / 255.0F};
    }
    return picture->palette != NULL;
}

// A pixel of a Radiance file is three whole numbers below 256 and one power of two for all, and means the middles of
// their steps (G. Ward, "Real Pixels", 1991); OpenImageIO gives the lower ends. The greatest number is at least 128.
static void centre_steps(const Picture *picture)
{
    float *values = picture->samples;
    size_t pixels = (size_t)picture->width * (size_t)picture->height, channels = (size_t)picture->channels;
    for (float *pixel = values; pixel < values + pixels * channels; pixel += channels) {
        float greatest = 0.0F;
        int exponent;
        for (size_t c = 0; c < channels; c++) {
            greatest = fmaxf(greatest, pixel[c]);
        }
        (void)frexpf(greatest, &exponent);
        for (size_t c = 0; greatest > 0.0F && c < channels; c++) {
            pixel[c] += ldexpf(0.5F, exponent - 8);
        }
    }
}

// POV-Ray reads OpenEXR as numbers of half precision: eleven bits, and no less than 2^-24.
static float half_of(float value)
{
    int exponent;
    (void)frexpf(value, &exponent);
    float step = ldexpf(1.0F, (exponent > -13 ? exponent : -13) - 11);
    return fmaxf(fminf(rintf(value / step) * step, 65504.0F), -65504.0F);
}

// What is no number is black.
static void round_to_half(const Picture *picture)
{
    float *values = picture->samples;
    size_t count = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
    for (size_t i = 0; i < count; i++) {
        values[i] = isfinite(values[i]) ? half_of(values[i]) : 0.0F;
    }
}

static void convert_floats(const Picture *picture, const Way *way)
{
    float *values = picture->samples;
    size_t channels = (size_t)picture->channels, colours = channels - (channels % 2 == 0 ? 1 : 0);
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; !way->is_kept && i < pixels; i++) {
        for (size_t c = 0; c < colours; c++) {
            values[i * channels + c] = (float)way_go(way, values[i * channels + c]);
        }
    }
}

// Takes the samples over. False when out of memory.
static bool picture_take(Picture *picture, const PictureSource *source, PictureFile *file)
{
    static const PictureDepth depths[] = {[IMAGE_DEPTH_8] = PICTURE_DEPTH_8,
                                          [IMAGE_DEPTH_16] = PICTURE_DEPTH_16,
                                          [IMAGE_DEPTH_FLOAT] = PICTURE_DEPTH_FLOAT};
    Way way = way_choose(source, file);
    picture->width = file->width;
    picture->height = file->height;
    picture->layers = file->layers;
    picture->channels = file->channels;
    picture->depth = depths[file->depth];
    picture->places = (uint32_t)file->palette_count;
    picture->samples = file->samples;
    picture->is_associated = source->alpha == PICTURE_ALPHA_UNSAID ? file->is_associated
                                                                   : source->alpha == PICTURE_ALPHA_ASSOCIATED;
    file->samples = NULL;
    if (picture->places > 0) {
        return make_palette(picture, file, &way);
    }
    if (picture->depth == PICTURE_DEPTH_FLOAT) {
        if (source->format != PICTURE_DF3) {
            (source->format == PICTURE_HDR ? centre_steps : round_to_half)(picture);
        }
        convert_floats(picture, &way);
        return true;
    }
    return make_table(picture, &way,
                      source->format == PICTURE_PNG && file->channels == 1 && file->depth == IMAGE_DEPTH_8);
}

// ---- reading

// Forms that POV-Ray stumbles over or reads otherwise than they are meant; NULL for none.
static const char *form_trouble(const PictureSource *source, const PictureFile *file)
{
    if (source->format == PICTURE_TIFF && (file->bits != 8 || file->channels % 2 == 0)) {
        return "it is a TIFF file of other than 8 bits or with alpha, of which POV-Ray reads 8 bits, multiplied with "
               "alpha";
    }
    if (source->format == PICTURE_PNG && file->has_key && file->channels == 1 && file->depth == IMAGE_DEPTH_8) {
        return "it is a grey PNG file with a transparent grey, which ends POV-Ray";
    }
    if ((source->format == PICTURE_PPM && file->channels != 3) ||
        (source->format == PICTURE_PGM && file->channels != 1)) {
        return "it has another number of colours than its type";
    }
    return NULL;
}

static void report_too_large(rt_session *session, const Picture *picture, const char *path, const PictureFile *file)
{
    char limit[LIMITS_BYTES_TEXT];
    limits_bytes_text(session_memory_granted(session), limit);
    if (diag_report(&session->diags, DIAG_E0608, picture->span,
                    "the picture `%s` of %d x %d pixels does not fit the memory limit of %s", path, file->width,
                    file->height, limit)) {
        diag_suggest(&session->diags, "`--max-memory` allows more");
    }
}

static void report_status(rt_session *session, const Picture *picture, const PictureSource *source, ImageStatus status,
                          const PictureFile *file, const ImageError *error)
{
    DiagSink *diags = &session->diags;
    const char *path = source->path, *detail = error->detail, *colon = detail[0] ? ": " : "";
    size_t length = strlen(source->real);
    if (strncmp(detail, source->real, length) == 0 && strncmp(detail + length, ": ", 2) == 0) {
        detail += length + 2;
    }
    switch (error->no_memory ? IMAGE_NO_MEMORY : status) {
    case IMAGE_OK: break;
    case IMAGE_NO_MEMORY: diag_report(diags, DIAG_E0602, picture->span, "out of memory reading `%s`", path); break;
    case IMAGE_NO_MODULE:
        diag_report(diags, DIAG_E0507, picture->span, "reading `%s` needs %s, which cannot be loaded%s%s",
                    path, source->format == PICTURE_JPEG ? "libjpeg" : "OpenImageIO", colon, detail);
        break;
    case IMAGE_TOO_LARGE: report_too_large(session, picture, path, file); break;
    case IMAGE_IO: diag_report(diags, DIAG_E0502, picture->span, "cannot read `%s`%s%s", path, colon, detail); break;
    case IMAGE_UNKNOWN_FORMAT:
    case IMAGE_BAD_DEPTH:
    case IMAGE_NOT_A_PICTURE:
        diag_report(diags, DIAG_E0511, picture->span, "`%s` cannot be read as a %s file%s%s", path,
                    picture_format_word((PictureFormat)source->format), colon, detail);
        break;
    }
}

static bool picture_load(rt_session *session, Scene *scene, size_t index)
{
    const PictureSource *source = &scene->picture_sources.items[index];
    Picture *picture = &scene->pictures.items[index];
    uint64_t used = scene_bytes(scene), most = session_memory_granted(session);
    PictureLimit limit = {UINT64_MAX, most > used ? most - used : 0, &session->cancel};
    PictureFile file;
    ImageError error;
    if (session->is_untrusted && source->format != PICTURE_PNG) {
        diag_report(&session->diags, DIAG_E0513, picture->span, "`--untrusted` reads pictures in PNG only");
        return false;
    }
    const char *format = picture_format_word((PictureFormat)source->format);
    ImageStatus status = session->has_readers && !picture_file_is_own(format)
                             ? picture_reader_read(&session->reader, source->real, format, &limit, &file, &error)
                             : picture_file_read_real(source->real, format, &limit, &file, &error);
    if (status != IMAGE_OK && atomic_load(&session->cancel)) {
        return false;
    }
    if (status != IMAGE_OK) {
        report_status(session, picture, source, status, &file, &error);
        return false;
    }
    const char *trouble = form_trouble(source, &file);
    if (file.is_damaged) {
        diag_report(&session->diags, DIAG_W0502, picture->span, "`%s` is damaged: parts of it are filled in",
                    source->path);
    }
    if (trouble) {
        diag_report(&session->diags, DIAG_E0511, picture->span, "`%s` cannot be used: %s", source->path, trouble);
        diag_suggest(&session->diags, "save the picture as PNG");
    } else if (!picture_take(picture, source, &file)) {
        report_status(session, picture, source, IMAGE_NO_MEMORY, &file, &error);
        trouble = "";
    }
    picture_file_fini(&file);
    return !trouble;
}

// Places that `filter` and `transmit` name must be in the palette.
static bool check_shades(rt_session *session, const Scene *scene, const ImageMap *map)
{
    const Picture *picture = &scene->pictures.items[map->picture];
    for (uint32_t i = map->shades; i != RECORD_NONE; i = scene->picture_shades.items[i].next) {
        const PictureShade *shade = &scene->picture_shades.items[i];
        Span span = {shade->source, shade->source + strlen(shade->is_filter ? "filter" : "transmit")};
        if (shade->place == SHADE_ALL || shade->place < picture->places) {
            continue;
        }
        const char *path = scene->picture_sources.items[map->picture].path;
        if (picture->places > 0) {
            diag_report(&session->diags, DIAG_E0512, span, "the palette of `%s` has places from 0 to %lu, not %lu",
                        path, (unsigned long)picture->places - 1, (unsigned long)shade->place);
        } else if (diag_report(&session->diags, DIAG_E0512, span, "`%s` has no palette to name a place of", path)) {
            diag_suggest(&session->diags, "`all` in the number's stead makes the whole picture transparent");
        }
        return false;
    }
    return true;
}

bool session_load_pictures(rt_session *session, Scene *scene)
{
    bool fine = true;
    for (size_t i = 0; fine && i < scene->pictures.count; i++) {
        fine = (scene->pictures.items[i].samples || picture_load(session, scene, i)) && !atomic_load(&session->cancel);
    }
    for (size_t i = 0; fine && i < scene->image_maps.count; i++) {
        fine = check_shades(session, scene, &scene->image_maps.items[i]);
    }
    return fine;
}
