// Pictures of every format but PNG, written and read by OpenImageIO behind a C boundary.
//
// The only C++ file: a module of its own, because linking OpenImageIO costs each start over a tenth of a second.
// Nothing is thrown out of it. It opens no file to write: files are made in memory and handed over whole, because
// OpenImageIO's writers do not bear a full disk (that of JPEG ends the process, those of TIFF and BMP hide it).
//
// SPDX-License-Identifier: MIT
#include "image/oiio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

namespace
{

constexpr int rows_at_once = 64; // a multiple of the rows in an EXR block, so that none is written in two parts
constexpr int check_size = 16;

// One line, cut to fit, without control characters. OpenImageIO joins its messages by newlines: the first one counts.
void set_detail(ImageError *error, const std::string &text)
{
    size_t length = std::min({text.size(), text.find('\n'), sizeof error->detail - 1});

    std::memcpy(error->detail, text.data(), length);
    error->detail[length] = '\0';
    std::replace_if(
        error->detail, error->detail + length, [](unsigned char c) { return c < ' ' || c == 127; }, '?');
}

// A file in memory that can be read while it is written: the writer of TIFF reads its directory again.
class MemoryFile final : public OIIO::Filesystem::IOVecOutput
{
  public:
    size_t read(void *data, size_t length) override
    {
        size_t done = pread(data, length, m_pos);
        m_pos += static_cast<int64_t>(done);
        return done;
    }

    size_t pread(void *data, size_t length, int64_t offset) override
    {
        const std::vector<unsigned char> &bytes = buffer();
        size_t from = std::min(static_cast<size_t>(offset), bytes.size());
        size_t done = std::min(length, bytes.size() - from);

        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), done, static_cast<unsigned char *>(data));
        return done;
    }
};

OIIO::TypeDesc sample_type(ImageDepth depth)
{
    switch (depth) {
    case IMAGE_DEPTH_8:
        return OIIO::TypeDesc::UINT8;
    case IMAGE_DEPTH_16:
        return OIIO::TypeDesc::UINT16;
    case IMAGE_DEPTH_FLOAT:
        break;
    }
    return OIIO::TypeDesc::FLOAT;
}

// Of all samples where the picture has channels of several types.
void add_channels(const OiioPicture &picture, OIIO::ImageSpec &spec)
{
    spec.channelformats.assign(static_cast<size_t>(picture.channels), OIIO::TypeDesc::FLOAT);
    for (int i = 0; i < picture.more_count; i++) {
        spec.channelnames.emplace_back(picture.more[i].name);
        spec.channelformats.push_back(picture.more[i].is_count ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
    }
    spec.nchannels += picture.more_count;
}

// Opens a writer onto the file. A format that can be written only to a path is refused: see above.
ImageStatus open_output(const OiioPicture &picture, MemoryFile &file, std::unique_ptr<OIIO::ImageOutput> &output,
                        ImageError *error)
{
    std::string name = std::string("picture.") + picture.ending;
    OIIO::TypeDesc type = sample_type(picture.depth);
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type);

    output = OIIO::ImageOutput::create(name);
    if (!output || std::strcmp(output->format_name(), "null") == 0 || !output->supports("ioproxy")) {
        set_detail(error, output ? "not a format that can be written safely" : OIIO::geterror());
        return IMAGE_UNKNOWN_FORMAT;
    }
    // No oiio:ColorSpace: OpenImageIO 2.4 then adds an Exif directory to TIFF, which breaks a file written to memory.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (picture.more_count > 0) {
        add_channels(picture, spec);
    }
    spec.attribute("DateTime", ""); // else the writers of EXR and TIFF add the hour
    for (size_t i = 0; i < picture.note_count; i++) {
        spec.attribute(picture.notes[i].name, picture.notes[i].text);
    }
    if (!output->set_ioproxy(&file) || !output->open(name, spec)) {
        set_detail(error, output->geterror());
        return IMAGE_IO;
    }
    return output->spec().format == type ? IMAGE_OK : IMAGE_BAD_DEPTH;
}

ImageStatus write_rows(const OiioPicture &picture, OIIO::ImageOutput &output, ImageError *error)
{
    OIIO::TypeDesc type = sample_type(picture.depth);
    size_t channels = static_cast<size_t>(picture.channels + picture.more_count);
    size_t row_bytes = static_cast<size_t>(picture.width) * channels * type.size();
    // UNKNOWN: as the file has them, each channel in its own type.
    OIIO::TypeDesc given = picture.more_count > 0 ? OIIO::TypeDesc(OIIO::TypeDesc::UNKNOWN) : type;
    std::vector<unsigned char> samples(row_bytes * static_cast<size_t>(std::min(rows_at_once, picture.height)));

    for (int y = 0; y < picture.height; y += rows_at_once) {
        int end = std::min(y + rows_at_once, picture.height);
        picture.fetch(picture.client, y, end - y, samples.data());
        if (!output.write_scanlines(y, end, 0, given, samples.data())) {
            set_detail(error, output.geterror());
            return IMAGE_IO;
        }
    }
    return IMAGE_OK;
}

ImageStatus write_picture(const OiioPicture &picture, MemoryFile &file, ImageError *error)
{
    std::unique_ptr<OIIO::ImageOutput> output;
    ImageStatus status = open_output(picture, file, output, error);

    if (status != IMAGE_OK) {
        return status;
    }
    status = write_rows(picture, *output, error);
    if (!output->close() && status == IMAGE_OK) {
        set_detail(error, output->geterror());
        status = IMAGE_IO;
    }
    return status;
}

void fetch_black(const void *, int, int, void *)
{
} // the buffer begins cleared

ImageStatus format_check(const char *ending, ImageDepth depth, ImageError *error)
{
    MemoryFile file;
    OiioPicture picture = {ending, check_size, check_size, 3, depth, nullptr, 0, nullptr, 0, nullptr, fetch_black};

    return write_picture(picture, file, error);
}

ImageStatus picture_save(const OiioPicture *picture, const OiioSink *sink, ImageError *error)
{
    MemoryFile file;
    ImageStatus status = write_picture(*picture, file, error);

    return status == IMAGE_OK ? sink->put(sink->client, file.buffer().data(), file.buffer().size(), error) : status;
}

using Allocate = ImageStatus (*)(PictureFile *file, const PictureLimit *limit);

bool has_size(const OIIO::ImageSpec &spec)
{
    return spec.width > 0 && spec.height > 0 && spec.depth <= 1 && spec.nchannels > 0;
}

ImageDepth depth_of(OIIO::TypeDesc type)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
    case OIIO::TypeDesc::INT8:
        return IMAGE_DEPTH_8;
    case OIIO::TypeDesc::UINT16:
    case OIIO::TypeDesc::INT16:
        return IMAGE_DEPTH_16;
    default:
        return IMAGE_DEPTH_FLOAT;
    }
}

// A format that is named is not guessed by the path's ending or by trying all. Null: the error says why.
std::unique_ptr<OIIO::ImageInput> input_open(const char *path, const char *format, ImageError *error)
{
    // A relative path that looks like an address of the network is still a path.
    std::string name = path[0] == '/' ? std::string(path) : std::string("./") + path;
    OIIO::ImageSpec config, found;
    config.attribute("oiio:UnassociatedAlpha", 1);
    auto input = format != nullptr ? OIIO::ImageInput::create(format) : OIIO::ImageInput::open(name, &config);

    if (!input) {
        set_detail(error, OIIO::geterror());
    } else if (format != nullptr && !input->open(name, found, config)) {
        set_detail(error, input->geterror());
        input.reset();
    }
    return input;
}

ImageStatus picture_load(const char *path, const char *format, const PictureLimit *limit, Allocate allocate,
                         PictureFile *file, ImageError *error)
{
    auto input = input_open(path, format, error);

    if (!input) {
        return IMAGE_NOT_A_PICTURE;
    }
    const OIIO::ImageSpec &spec = input->spec();
    if (!has_size(spec) || (format != nullptr && std::strcmp(input->format_name(), format) != 0)) {
        set_detail(error, std::string("it is of type ") + input->format_name());
        return IMAGE_NOT_A_PICTURE;
    }
    file->width = spec.width;
    file->height = spec.height;
    file->channels = std::min(spec.nchannels, 4);
    file->depth = depth_of(spec.format);
    file->bits = spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * spec.format.size()));
    file->is_associated = spec.alpha_channel >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
    ImageStatus status = allocate(file, limit);
    if (status != IMAGE_OK) {
        return status;
    }
    if (!input->read_image(0, 0, 0, file->channels, sample_type(file->depth), file->samples)) {
        set_detail(error, input->geterror());
        return IMAGE_NOT_A_PICTURE;
    }
    return IMAGE_OK;
}

// Runs a function, and turns whatever it throws into a status.
template <typename Function, typename... Arguments>
ImageStatus guarded(Function function, ImageError *error, Arguments... arguments) noexcept
{
    try {
        return function(arguments..., error);
    } catch (const std::bad_alloc &) {
        return IMAGE_NO_MEMORY;
    } catch (const std::exception &exception) {
        set_detail(error, exception.what());
    } catch (...) {
        set_detail(error, "unknown exception");
    }
    return IMAGE_IO;
}

} // namespace

extern "C" {

static ImageStatus module_check(const char *ending, ImageDepth depth, ImageError *error) noexcept
{
    return guarded(format_check, error, ending, depth);
}

static ImageStatus module_write(const OiioPicture *picture, const OiioSink *sink, ImageError *error) noexcept
{
    return guarded(picture_save, error, picture, sink);
}

static ImageStatus module_read(const char *path, const char *format, const PictureLimit *limit, Allocate allocate,
                               PictureFile *file, ImageError *error) noexcept
{
    return guarded(picture_load, error, path, format, limit, allocate, file);
}

const OiioModule rtlang_oiio_module = {OIIO_MODULE_VERSION, module_check, module_write, module_read};

} // extern "C"
