#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "preprocessing/average_face.h"
#include "preprocessing/template_registration.h"

namespace mimik::preprocessing {

/// Where the template of an average face comes to lie on faces, and how expressions move it. What was found is kept in
/// a folder, and read again by whoever asks next, as long as template, options and scans are the same:
///   bs000/bs000_N_N_0.{ply,json}      the template bent on to the neutral scan
///   bs000/bs000_LFAU_12_0.{ply,json}  the same as the expression moves it, with `displacement_mm` per vertex
/// All meshes share vertices and faces: dense correspondence for any program. Scanner frame of the subject's first
/// neutral scan, mm; `matched` is 1 where a vertex lies on the scan. From any thread.
class KeptRegistrations {
public:
    /// Of an average face, whose template is made when it is first needed.
    /// @param folder  empty: nothing is kept. Where it cannot be written, nothing is kept either.
    explicit KeptRegistrations(AverageFace average, std::filesystem::path folder = {});
    /// Of any template; keeps nothing.
    explicit KeptRegistrations(FaceTemplate face_template);

    /// @throws InputError if the average face has no template (build_face_template).
    [[nodiscard]] const TemplateRegistration& registration() const;
    [[nodiscard]] const FaceTemplate& face_template() const {
        return given_ ? *given_ : registration().face_template();
    }
    /// @throws as TemplateRegistration::neutral.
    [[nodiscard]] RegisteredTemplate neutral(const Face& face) const;
    /// @throws as TemplateRegistration::motion.
    [[nodiscard]] RegisteredMotion motion(const Face& neutral, const Face& expressive) const;
    /// The files of a face's registration without .ply and .json; empty if none is kept of it.
    [[nodiscard]] std::filesystem::path stem(const Face& face) const;

private:
    [[nodiscard]] std::string made_from(const Face& neutral, const Face* expressive) const;

    AverageFace average_;
    std::optional<FaceTemplate> given_;
    std::filesystem::path folder_;
    mutable std::once_flag making_;
    mutable std::unique_ptr<const TemplateRegistration> registration_;
    mutable std::string fingerprint_;  ///< of template and options
};

/// Tells one template from another: 16 hexadecimal digits over vertices, faces, landmarks and cut.
[[nodiscard]] std::string template_fingerprint(const FaceTemplate& face_template);

}  // namespace mimik::preprocessing
