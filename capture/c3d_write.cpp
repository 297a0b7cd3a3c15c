// Writing C3D; c3d_read.cpp reads it.
#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "capture/c3d.h"
#include "capture/c3d_bytes.h"

namespace mimik::capture {

void C3dWriteOptions::check() const {
    if (integer_step_mm && (!std::isfinite(*integer_step_mm) || *integer_step_mm <= 0))
        throw InputError(fmt::format("integer_step_mm is {}; give one above 0", *integer_step_mm));
}

namespace {

constexpr std::size_t labels_a_list = 255, longest_name = 127, most_parameter_blocks = 255;

class Bytes {
public:
    Bytes(C3dProcessor processor, std::string name) : processor_(processor), name_(std::move(name)) {}

    void byte(unsigned value) { text_ += static_cast<char>(value & 0xFFU); }
    void word(unsigned value) {
        if (processor_ == C3dProcessor::sgi) {
            byte(value >> 8U);
            byte(value);
        } else {
            byte(value);
            byte(value >> 8U);
        }
    }
    void real(float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        auto first = static_cast<std::uint16_t>(bits & 0xFFFFU), second = static_cast<std::uint16_t>(bits >> 16U);
        if (processor_ == C3dProcessor::sgi) std::swap(first, second);
        if (processor_ == C3dProcessor::dec && !to_vax(value, first, second))
            throw InputError(fmt::format("{}: {} is beyond the reals of DEC; write another processor's", name_, value));
        word(first);
        word(second);
    }
    void text(std::string_view text, std::size_t length) {
        text_ += text.substr(0, length);
        text_.append(length - std::min(length, text.size()), ' ');
    }
    void append(const Bytes& other) { text_ += other.text_; }
    void fill_block() { text_.resize((text_.size() + c3d_block_bytes - 1) / c3d_block_bytes * c3d_block_bytes, '\0'); }
    [[nodiscard]] std::size_t size() const { return text_.size(); }
    [[nodiscard]] std::string take() { return std::move(text_); }

private:
    C3dProcessor processor_;
    std::string name_, text_;
};

/// The parameter section: groups and their parameters, one after another.
class Parameters {
public:
    Parameters(C3dProcessor processor, const std::string& name)
        : processor_(processor), file_(name), bytes_(processor, name) {
        bytes_.byte(1);
        bytes_.byte(0x50);
        bytes_.byte(0);  // blocks, as finish() says
        bytes_.byte(static_cast<unsigned>(processor));
    }
    void group(int id, std::string_view name) {
        bytes_.byte(static_cast<unsigned>(name.size()));
        bytes_.byte(static_cast<unsigned>(-id));
        bytes_.text(name, name.size());
        bytes_.word(3);  // to the next record: this word, no description
        bytes_.byte(0);
        group_ = id;
    }
    void word(std::string_view name, unsigned value) {
        auto values = scratch();
        values.word(value);
        add(name, 2, {}, values);
    }
    void words(std::string_view name, unsigned first, unsigned second) {
        auto values = scratch();
        values.word(first);
        values.word(second);
        add(name, 2, {2}, values);
    }
    void real(std::string_view name, float value) {
        auto values = scratch();
        values.real(value);
        add(name, 4, {}, values);
    }
    void texts(std::string_view name, std::span<const std::string> list) {
        std::size_t longest = 1;
        for (const auto& text : list) longest = std::max(longest, text.size());
        auto values = scratch();
        for (const auto& text : list) values.text(text, longest);
        add(name, -1, {static_cast<unsigned>(longest), static_cast<unsigned>(list.size())}, values);
    }
    /// Whole blocks, with their number.
    std::string finish() {
        bytes_.byte(0);  // no further record
        bytes_.byte(0);
        bytes_.fill_block();
        const auto blocks = bytes_.size() / c3d_block_bytes;
        if (blocks > most_parameter_blocks)
            throw InputError(
                fmt::format("{}: the names of the markers take {} blocks, and a C3D has {} for them; shorten "
                            "them, or write .trc",
                            file_, blocks, most_parameter_blocks));
        auto text = bytes_.take();
        text[2] = static_cast<char>(blocks);
        return text;
    }

private:
    [[nodiscard]] Bytes scratch() const { return {processor_, file_}; }
    void add(std::string_view name, int type, const std::vector<unsigned>& sizes, const Bytes& values) {
        bytes_.byte(static_cast<unsigned>(name.size()));
        bytes_.byte(static_cast<unsigned>(group_));
        bytes_.text(name, name.size());
        bytes_.word(static_cast<unsigned>(2 + 2 + sizes.size() + values.size() + 1));
        bytes_.byte(static_cast<unsigned>(type));
        bytes_.byte(static_cast<unsigned>(sizes.size()));
        for (const auto size : sizes) bytes_.byte(size);
        bytes_.append(values);
        bytes_.byte(0);  // no description
    }

    C3dProcessor processor_;
    std::string file_;
    Bytes bytes_;
    int group_ = 1;
};

unsigned capped(std::uint64_t value) { return static_cast<unsigned>(std::min<std::uint64_t>(value, 65535)); }

void check_names(const MarkerSequence& markers, const std::string& name) {
    if (markers.markers() == 0 || markers.frames() == 0)
        throw InputError(fmt::format("{}: there is no {} to write", name, markers.markers() == 0 ? "marker" : "frame"));
    if (markers.markers() > 65535)
        throw InputError(fmt::format("{}: {} markers, and a C3D holds 65535; write .trc", name, markers.markers()));
    // Two words of 16 bits each hold the first and the last.
    constexpr std::int64_t last_number = 0xFFFFFFFF;
    if (const auto last = markers.first_frame() + static_cast<std::int64_t>(markers.frames()) - 1; last > last_number)
        throw InputError(fmt::format("{}: frames are numbered up to {}, and a C3D holds up to {}; write .trc or .csv",
                                     name, last, last_number));
    for (const auto& one : markers.names())
        if (one.size() > longest_name)
            throw InputError(fmt::format("{}: the name {} is longer than {} bytes; shorten it", name,
                                         base::in_quotes(one), longest_name));
}

std::string encode_parameters(const MarkerSequence& markers, const std::string& name, const C3dWriteOptions& options,
                              float scale, unsigned data_block) {
    const auto frames = static_cast<std::uint64_t>(markers.frames());
    const auto first = static_cast<std::uint64_t>(std::max<std::int64_t>(markers.first_frame(), 0));
    const auto last = first + frames - 1;
    Parameters section(options.processor, name);
    section.group(1, "POINT");
    section.word("USED", static_cast<unsigned>(markers.markers()));
    section.real("SCALE", scale);
    section.real("RATE", static_cast<float>(markers.rate_hz()));
    section.word("DATA_START", data_block);
    section.word("FRAMES", capped(frames));
    if (frames > 65535) section.real("LONG_FRAMES", static_cast<float>(frames));
    for (std::size_t k = 0; k * labels_a_list < markers.markers(); ++k) {
        const auto count = std::min(labels_a_list, markers.markers() - k * labels_a_list);
        section.texts(k == 0 ? std::string("LABELS") : fmt::format("LABELS{}", k + 1),
                      markers.names().subspan(k * labels_a_list, count));
    }
    const std::string unit = "mm";
    section.texts("UNITS", {&unit, 1});
    section.group(2, "ANALOG");
    section.word("USED", 0);
    section.group(3, "TRIAL");
    section.words("ACTUAL_START_FIELD", static_cast<unsigned>(first & 0xFFFFU), static_cast<unsigned>(first >> 16U));
    section.words("ACTUAL_END_FIELD", static_cast<unsigned>(last & 0xFFFFU), static_cast<unsigned>(last >> 16U));
    return section.finish();
}

Bytes encode_header(const MarkerSequence& markers, const std::string& name, const C3dWriteOptions& options, float scale,
                    unsigned data_block) {
    const auto first = static_cast<std::uint64_t>(std::max<std::int64_t>(markers.first_frame(), 0));
    Bytes header(options.processor, name);
    header.byte(2);
    header.byte(0x50);
    header.word(static_cast<unsigned>(markers.markers()));
    header.word(0);  // analogue values
    header.word(capped(first));
    header.word(capped(first + markers.frames() - 1));
    header.word(0);  // largest gap that was interpolated
    header.real(scale);
    header.word(data_block);
    header.word(0);  // analogue samples a frame
    header.real(static_cast<float>(markers.rate_hz()));
    header.fill_block();
    return header;
}

unsigned residual_steps(const MarkerSequence& markers, std::size_t frame, std::size_t marker, float scale) {
    const float steps = std::round(markers.residual_mm(frame, marker) / std::abs(scale));
    return static_cast<unsigned>(std::clamp(steps, 0.0F, 255.0F));
}

/// The scale of reals is that of residuals alone, which are whole numbers up to 255.
float residual_step_mm(const MarkerSequence& markers) {
    constexpr float finest_mm = 0.01F, most_steps = 255.0F;
    float largest_mm = 0;
    for (std::size_t frame = 0; frame < markers.frames(); ++frame)
        for (std::size_t marker = 0; marker < markers.markers(); ++marker)
            if (markers.valid(frame, marker)) largest_mm = std::max(largest_mm, markers.residual_mm(frame, marker));
    return std::max(finest_mm, largest_mm / most_steps);
}

void append_integers(Bytes& bytes, const MarkerSequence& markers, std::size_t frame, std::size_t marker, float scale,
                     const std::string& name) {
    if (!markers.valid(frame, marker)) {
        for (int k = 0; k < 3; ++k) bytes.word(0);
        bytes.word(0xFFFFU);
        return;
    }
    for (int k = 0; k < 3; ++k) {
        const double steps = std::round(markers.at_mm(frame, marker)[k] / double{scale});
        if (std::abs(steps) > 32767)
            throw InputError(
                fmt::format("{}: marker {} is at {:.6g} mm, beyond 16-bit integers of {} mm; give larger steps", name,
                            base::in_quotes(markers.names()[marker]), markers.at_mm(frame, marker)[k], scale));
        bytes.word(static_cast<std::uint16_t>(static_cast<std::int16_t>(steps)));
    }
    bytes.word(residual_steps(markers, frame, marker, scale));
}

}  // namespace

std::string encode_c3d(const MarkerSequence& markers, const std::string& name, const C3dWriteOptions& options) {
    options.check();
    check_names(markers, name);
    const float scale =
        options.integer_step_mm ? static_cast<float>(*options.integer_step_mm) : -residual_step_mm(markers);
    // The number of the data's block has the same length whatever it is.
    const auto parameter_blocks = encode_parameters(markers, name, options, scale, 0).size() / c3d_block_bytes;
    const auto data_block = static_cast<unsigned>(2 + parameter_blocks);
    Bytes bytes = encode_header(markers, name, options, scale, data_block);
    auto text = bytes.take() + encode_parameters(markers, name, options, scale, data_block);
    Bytes data(options.processor, name);
    for (std::size_t frame = 0; frame < markers.frames(); ++frame)
        for (std::size_t marker = 0; marker < markers.markers(); ++marker) {
            if (options.integer_step_mm) {
                append_integers(data, markers, frame, marker, scale, name);
                continue;
            }
            for (int k = 0; k < 3; ++k) data.real(static_cast<float>(markers.at_mm(frame, marker)[k]));
            data.real(markers.valid(frame, marker) ? static_cast<float>(residual_steps(markers, frame, marker, scale))
                                                   : -1.0F);
        }
    data.fill_block();
    return text + data.take();
}

}  // namespace mimik::capture
