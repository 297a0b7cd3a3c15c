#include "video/rendered_performance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"
#include "base/random_stream.h"
#include "synthesis/builtin_curves.h"
#include "synthesis/photograph.h"
#include "synthesis/scanner.h"
#include "synthesis/subject.h"
#include "video/builtin_feature_lines.h"

namespace mimik::video {
namespace {

using geometry::Point;
using geometry::Vector;

/// What a performer does once: shapes that rise together, hold and fall.
struct Act {
    std::vector<std::pair<const char*, double>> shapes;
    double rise_s = 0.25, hold_s = 0.4, fall_s = 0.3;
};
const std::vector<Act>& acts() {
    static const std::vector<Act> all = {
        {{{"mouthSmile_L", 0.9}, {"mouthSmile_R", 0.9}, {"cheekSquint_L", 0.4}, {"cheekSquint_R", 0.4}}},
        {{{"jawOpen", 0.7}}},
        {{{"browInnerUp_L", 0.9}, {"browInnerUp_R", 0.9}, {"browOuterUp_L", 0.9}, {"browOuterUp_R", 0.9}}},
        {{{"mouthPucker", 0.8}}},
        {{{"browDown_L", 0.9}, {"browDown_R", 0.9}}},
        {{{"mouthStretch_L", 0.8}, {"mouthStretch_R", 0.8}, {"jawOpen", 0.25}}},
        {{{"mouthFrown_L", 0.8}, {"mouthFrown_R", 0.8}}},
        {{{"mouthFunnel", 0.7}, {"jawOpen", 0.3}}},
        {{{"mouthSmile_L", 0.9}}},
        {{{"mouthUpperUp_L", 0.7}, {"mouthUpperUp_R", 0.7}, {"mouthLowerDown_L", 0.7}, {"mouthLowerDown_R", 0.7}}},
        {{{"eyeWide_L", 0.8}, {"eyeWide_R", 0.8}, {"browInnerUp_L", 0.6}, {"browInnerUp_R", 0.6}}},
    };
    return all;
}

struct Event {
    double begin_s = 0;
    const Act* act = nullptr;
    double strength = 1;
};

double strength_at(const Event& event, double time_s) {
    const double t = time_s - event.begin_s, hold = event.act->rise_s + event.act->hold_s;
    if (t <= 0 || t >= hold + event.act->fall_s) return 0;
    const double up = synthesis::smooth_step(0, event.act->rise_s, t);
    return event.strength * up * (1 - synthesis::smooth_step(hold, hold + event.act->fall_s, t));
}

const Act& blink() {
    static const Act act = {{{"eyeBlink_L", 1.0}, {"eyeBlink_R", 1.0}}, 0.1, 0.06, 0.14};
    return act;
}

/// At rest for the first 0.7 s; then one act after another, and a blink every two to four seconds.
std::vector<Event> script(std::uint64_t seed, double length_s) {
    base::RandomStream random(seed, "performance/acts");
    std::vector<Event> events;
    auto next = static_cast<std::size_t>(random.uniform() * static_cast<double>(acts().size()));
    for (double t = 0.7; t < length_s; t += 0.75 + 0.4 * random.uniform()) {
        events.push_back({t, &acts()[next % acts().size()], 0.7 + 0.3 * random.uniform()});
        next += 1 + static_cast<std::size_t>(2 * random.uniform());
    }
    for (double t = 1.1; t < length_s; t += 2 + 2 * random.uniform()) events.push_back({t, &blink(), 1});
    return events;
}

/// Places of the head frame in the camera's.
struct Camera {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d translation_mm;
    double focal_px = 0, centre_x = 0, centre_y = 0;
    [[nodiscard]] Eigen::Vector3d at(const Point& head_mm) const { return rotation * head_mm + translation_mm; }
    [[nodiscard]] Pixel pixel_of_camera_point(const Eigen::Vector3d& p) const {
        return {focal_px * p.x() / p.z() + centre_x, focal_px * p.y() / p.z() + centre_y};
    }
    [[nodiscard]] Pixel pixel(const Point& head_mm) const { return pixel_of_camera_point(at(head_mm)); }
    /// The same camera with pixels of half the size.
    [[nodiscard]] Camera finer() const {
        return {rotation, translation_mm, 2 * focal_px, 2 * centre_x + 0.5, 2 * centre_y + 0.5};
    }
};

struct Hit {
    float depth = std::numeric_limits<float>::max();
    std::uint32_t triangle = 0xffffffff;
    float b0 = 0, b1 = 0;
};

/// Depth buffer of a surface seen by a camera.
std::vector<Hit> rasterise(const std::vector<Eigen::Vector3d>& camera_mm, const std::vector<Pixel>& pixels,
                           const std::vector<geometry::Triangle>& triangles, int width, int height) {
    std::vector<Hit> hits(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::uint32_t f = 0; f < triangles.size(); ++f) {
        const auto& [i, j, k] = triangles[f];
        const Pixel a = pixels[i], ab = pixels[j] - a, ac = pixels[k] - a;
        const double area = ab.x() * ac.y() - ab.y() * ac.x();
        if (std::abs(area) < 1e-12) continue;
        const auto bounds = [&](int axis, int size) {
            const auto [low, high] = std::minmax({pixels[i][axis], pixels[j][axis], pixels[k][axis]});
            return std::pair(std::max(0, static_cast<int>(std::ceil(low))),
                             std::min(size - 1, static_cast<int>(std::floor(high))));
        };
        const auto [x0, x1] = bounds(0, width);
        const auto [y0, y1] = bounds(1, height);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const Pixel at = Pixel(x, y) - a;
                const double b1 = (at.x() * ac.y() - at.y() * ac.x()) / area;
                const double b2 = (ab.x() * at.y() - ab.y() * at.x()) / area;
                if (b1 < 0 || b2 < 0 || b1 + b2 > 1) continue;
                const auto depth = static_cast<float>((1 - b1 - b2) * camera_mm[i].z() + b1 * camera_mm[j].z() +
                                                      b2 * camera_mm[k].z());
                auto& hit =
                    hits[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
                if (depth < hit.depth) hit = {depth, f, static_cast<float>(1 - b1 - b2), static_cast<float>(b1)};
            }
    }
    return hits;
}

cv::Scalar scalar(const Eigen::Vector3d& colour) { return {colour[0], colour[1], colour[2]}; }

void fill_ellipse(cv::Mat& image, const Camera& camera, const Point& centre_mm, double half_width_mm,
                  double half_height_mm, const Eigen::Vector3d& colour) {
    std::vector<cv::Point> outline;
    for (int k = 0; k < 64; ++k) {
        const double angle = 2 * EIGEN_PI * k / 64;
        const auto at =
            camera.pixel(centre_mm + Point(half_width_mm * std::cos(angle), half_height_mm * std::sin(angle), 0));
        outline.emplace_back(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
    }
    cv::fillPoly(image, std::vector<std::vector<cv::Point>>{outline}, scalar(colour));
}

Eigen::Vector3d mix(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share_of_b) {
    return a + share_of_b * (b - a);
}

/// The ball of an eye at `offset` (mm) from the middle of its iris.
Eigen::Vector3d eye_colour(const Eigen::Vector2d& offset, const Eigen::Vector3d& iris) {
    using synthesis::smooth_step;
    const double radius = offset.norm();
    if ((offset - Eigen::Vector2d(1.4, 1.6)).norm() < 0.7) return {250, 250, 250};
    Eigen::Vector3d colour = mix({26, 20, 18}, iris, smooth_step(2.0, 2.6, radius));
    colour = mix(colour, iris * 0.5, smooth_step(4.6, 5.8, radius));
    colour = mix(colour, {222, 214, 208}, smooth_step(5.6, 6.3, radius));
    return colour * (1.0 - 0.35 * smooth_step(6.0, 15.0, radius));
}

}  // namespace

void PerformanceOptions::check() const {
    const auto within = [](const char* name, double value, double from, double to) {
        if (!(value >= from && value <= to))
            throw InputError(fmt::format("{} is {}; give {} to {}", name, value, from, to));
    };
    within("width_px", width_px, 64, 4096);
    within("height_px", height_px, 64, 4096);
    within("rate_hz", rate_hz, 1, 1000);
    within("frames", frames, 1, 1000000);
    within("expression", expression, 0, 1.2);
    within("head_motion", head_motion, 0, 3);
    within("light_change", light_change, 0, 0.9);
    within("noise", noise, 0, 60);
    within("distance_mm", distance_mm, 300, 3000);
}

struct RenderedPerformance::Parts {
    PerformanceOptions options;
    std::unique_ptr<synthesis::FaceModel> model = synthesis::make_builtin_face_model();
    BuiltinFeatureLines lines = builtin_feature_lines();
    synthesis::Subject subject;
    synthesis::Complexion complexion;
    std::vector<geometry::Triangle> triangles;
    std::vector<Event> events;
    Point origin_mm = Point::Zero();  ///< of the head frame, in the model's
    std::array<Point, 2> irises;      ///< of the resting face, in the head frame
    double outer_eyes_mm = 0;

    explicit Parts(const PerformanceOptions& given) : options(given) {
        subject = synthesis::draw_subject(*model, "performer", options.seed);
        const auto window = synthesis::face_window(*model, subject.resting_mm);
        complexion = synthesis::draw_complexion(*model, subject, window, options.seed);
        triangles = geometry::triangulate(model->faces());
        events = script(options.seed, options.frames / options.rate_hz);
        const auto& marks = model->landmark_vertices();
        const auto at = [&](const char* name) { return subject.resting_mm[marks.at(name)]; };
        origin_mm = 0.5 * (at("eye_outer_left") + at("eye_outer_right"));
        outer_eyes_mm = (at("eye_outer_left") - at("eye_outer_right")).norm();
        irises = {0.5 * (at("eye_outer_left") + at("eye_inner_left")) - origin_mm,
                  0.5 * (at("eye_outer_right") + at("eye_inner_right")) - origin_mm};
    }

    [[nodiscard]] std::map<std::string, double> weights(double time_s) const {
        std::map<std::string, double> sum;
        for (const auto& event : events) {
            const double strength = strength_at(event, time_s) * options.expression;
            if (strength <= 0) continue;
            for (const auto& [shape, weight] : event.act->shapes)
                sum[shape] = std::min(1.0, sum[shape] + strength * weight);
        }
        return sum;
    }

    /// The skin in the head frame.
    [[nodiscard]] std::vector<Point> skin(const std::map<std::string, double>& weights_now) const {
        std::vector<Vector> moved(subject.resting_mm.size(), Vector::Zero());
        synthesis::Contact contact;
        for (const auto& [shape, weight] : weights_now) {
            const auto found = std::lower_bound(subject.shapes.begin(), subject.shapes.end(), shape);
            if (found == subject.shapes.end() || *found != shape)
                throw InputError(fmt::format("the built-in face has no shape '{}'", shape));
            const auto& full = subject.shape_displacements_mm[static_cast<std::size_t>(found - subject.shapes.begin())];
            for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += weight * full[i];
            contact.left_eye_closed = contact.left_eye_closed || (shape == "eyeBlink_L" && weight > 0.95);
            contact.right_eye_closed = contact.right_eye_closed || (shape == "eyeBlink_R" && weight > 0.95);
        }
        if (!weights_now.empty()) model->settle(subject.resting_mm, contact, moved);
        std::vector<Point> skin_mm(moved.size());
        for (std::size_t i = 0; i < moved.size(); ++i) skin_mm[i] = subject.resting_mm[i] + moved[i] - origin_mm;
        return skin_mm;
    }

    [[nodiscard]] Camera camera(double time_s) const {
        base::RandomStream random(options.seed, "performance/head");
        const auto wave = [&](double amount, double slowest_s) {
            const double period = slowest_s * (0.7 + 0.6 * random.uniform()), phase = random.uniform();
            // It starts at rest: the first frames are the guided neutral.
            const double begun = synthesis::smooth_step(0.5, 1.5, time_s);
            return options.head_motion * begun * amount * std::sin(2 * EIGEN_PI * (time_s / period + phase));
        };
        constexpr double degree = EIGEN_PI / 180;
        const double yaw = wave(12 * degree, 5), pitch = wave(7 * degree, 4), roll = wave(6 * degree, 6);
        const Eigen::Matrix3d turn =
            (Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
             Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()))
                .toRotationMatrix();
        Camera camera;
        // The head's axes to the camera's, then the turn about a point behind the face, as on a neck.
        camera.rotation = turn * Eigen::Vector3d(1, -1, -1).asDiagonal();
        const Point neck(0, -40, -90);
        const Eigen::Vector3d at_rest(0, -25, options.distance_mm);
        camera.translation_mm = at_rest + Eigen::Vector3d(wave(25, 7), wave(12, 5), wave(40, 9)) +
                                Eigen::Vector3d(1, -1, -1).asDiagonal() * neck - camera.rotation * neck;
        camera.focal_px = 1.2 * options.width_px;
        camera.centre_x = 0.5 * (options.width_px - 1);
        camera.centre_y = 0.5 * (options.height_px - 1);
        return camera;
    }

    /// What stands behind the face: a wall, shoulders, neck, hair; and the mouth's inside, which the lips' gap shows.
    [[nodiscard]] cv::Mat backdrop(const Camera& camera, const std::vector<Point>& skin_mm, int width,
                                   int height) const {
        cv::Mat image(height, width, CV_32FC3);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const auto shade = static_cast<float>(1 + 0.15 * x / width - 0.12 * y / height);
                image.at<cv::Vec3f>(y, x) = cv::Vec3f(104, 112, 120) * shade;
            }
        const Eigen::Vector3d skin_colour = complexion.colours[model->landmark_vertices().at("chin")];
        fill_ellipse(image, camera, {0, -260, -110}, 210, 110, {70, 78, 96});
        fill_ellipse(image, camera, {0, -150, -95}, 56, 110, 0.62 * skin_colour);
        fill_ellipse(image, camera, {0, 22, -95}, 84, 104, 0.8 * complexion.hair);
        const auto inside = [&](FaceCurve upper, FaceCurve lower, double from, double to,
                                const Eigen::Vector3d& colour) {
            std::vector<cv::Point> outline;
            const auto& above = lines.curves[static_cast<std::size_t>(upper)];
            const auto& below = lines.curves[static_cast<std::size_t>(lower)];
            const auto add = [&](std::size_t k, double share) {
                const auto low = below[std::min(k * below.size() / above.size(), below.size() - 1)];
                const Pixel at = camera.pixel(mix(skin_mm[above[k]], skin_mm[low], share) - Point(0, 0, 4));
                outline.emplace_back(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
            };
            for (std::size_t k = 0; k < above.size(); ++k) add(k, from);
            for (std::size_t k = above.size(); k-- > 0;) add(k, to);
            cv::fillPoly(image, std::vector<std::vector<cv::Point>>{outline}, scalar(colour));
        };
        inside(FaceCurve::lip_outer_upper, FaceCurve::lip_outer_lower, 0, 1, {52, 20, 20});
        inside(FaceCurve::lip_inner_upper, FaceCurve::lip_inner_lower, -0.3, 0.28, {196, 186, 170});
        return image;
    }
    [[nodiscard]] Eigen::Vector3d colour_of(const Hit& hit, const std::vector<Point>& skin_mm,
                                            const std::vector<Vector>& normals, const Vector& light) const {
        const auto& corners = triangles[hit.triangle];
        const std::array<double, 3> b = {hit.b0, hit.b1, 1.0 - hit.b0 - hit.b1};
        Eigen::Vector3d albedo = Eigen::Vector3d::Zero(), at = Eigen::Vector3d::Zero(), normal = Vector::Zero();
        Eigen::Vector3d resting = Eigen::Vector3d::Zero();
        double hair = 0, ball = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            albedo += b[c] * complexion.colours[corners[c]];
            at += b[c] * skin_mm[corners[c]];
            resting += b[c] * subject.resting_mm[corners[c]];
            normal += b[c] * normals[corners[c]];
            hair += b[c] * complexion.hairiness[corners[c]];
            ball += b[c] * complexion.eyeball[corners[c]];
        }
        if (ball > 0.5) {
            const auto& iris = at.x() > 0 ? irises[0] : irises[1];
            return eye_colour({at.x() - iris.x(), at.y() - iris.y() - 0.5}, complexion.iris);
        }
        if (hair > 0) {
            const double x = resting.x(), y = resting.y();
            const double strands =
                0.8 + 0.2 * std::sin(5.0 * x + 1.8 * y + 2.0 * std::sin(0.7 * y)) * std::sin(2.1 * y - 1.3 * x);
            albedo = mix(albedo, complexion.hair, std::clamp(hair * strands, 0.0, 1.0));
        }
        normal.normalize();
        // Some light comes from everywhere; a nostril's rim and the corner of an eye get less of it.
        const double shade =
            0.38 + 0.55 * std::max(0.0, normal.dot(light)) + 0.17 * std::max(0.0, normal.dot(Vector(-0.6, 0.1, 0.79)));
        return albedo * shade;
    }

    [[nodiscard]] cv::Mat paint(const Camera& camera, const std::vector<Point>& skin_mm, double time_s) const {
        const int width = 2 * options.width_px, height = 2 * options.height_px;
        const auto fine = camera.finer();
        cv::Mat image = backdrop(fine, skin_mm, width, height);
        std::vector<Eigen::Vector3d> camera_mm(skin_mm.size());
        std::vector<Pixel> pixels(skin_mm.size());
        for (std::size_t i = 0; i < skin_mm.size(); ++i) {
            camera_mm[i] = fine.at(skin_mm[i]);
            pixels[i] = fine.pixel_of_camera_point(camera_mm[i]);
        }
        const auto hits = rasterise(camera_mm, pixels, triangles, width, height);
        const auto normals = geometry::vertex_normals(skin_mm, triangles);
        // The lamps stand still while the head turns: their direction in the head's frame.
        const double swing = 0.5 * std::sin(2 * EIGEN_PI * time_s / 11) * options.light_change;
        const Vector light = camera.rotation.transpose() * Vector(0.25 + swing, -0.45, -0.86).normalized();
        const double level = 1 + options.light_change * std::sin(2 * EIGEN_PI * time_s / 8);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                auto& to = image.at<cv::Vec3f>(y, x);
                const auto& hit =
                    hits[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
                if (hit.triangle != Hit().triangle) {
                    const auto colour = colour_of(hit, skin_mm, normals, light);
                    to = {static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2])};
                }
                to *= static_cast<float>(level);
            }
        return image;
    }
};

RenderedPerformance::RenderedPerformance(const PerformanceOptions& options) {
    options.check();
    parts_ = std::make_unique<Parts>(options);
}
RenderedPerformance::~RenderedPerformance() = default;

double RenderedPerformance::outer_eyes_mm() const { return parts_->outer_eyes_mm; }
double RenderedPerformance::focal_px() const { return parts_->camera(0).focal_px; }

io::Image RenderedPerformance::image(int frame) const {
    const auto& options = parts_->options;
    const double time_s = frame / options.rate_hz;
    const auto fine = parts_->paint(parts_->camera(time_s), parts_->skin(parts_->weights(time_s)), time_s);
    cv::Mat small, noise(options.height_px, options.width_px, CV_32FC3);
    cv::resize(fine, small, cv::Size(options.width_px, options.height_px), 0, 0, cv::INTER_AREA);
    // A lens is not sharper than this.
    cv::GaussianBlur(small, small, cv::Size(3, 3), 0.6);
    if (options.noise > 0) {
        cv::RNG random(base::stream_seed(options.seed, fmt::format("performance/noise/{}", frame)));
        random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(options.noise));
        small += noise;
    }
    io::Image image;
    image.width = options.width_px;
    image.height = options.height_px;
    image.rgb.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    cv::Mat bytes(image.height, image.width, CV_8UC3, image.rgb.data());
    small.convertTo(bytes, CV_8UC3);
    return image;
}

PerformanceTruth RenderedPerformance::truth(int frame) const {
    PerformanceTruth truth;
    truth.time_s = frame / parts_->options.rate_hz;
    truth.weights = parts_->weights(truth.time_s);
    const auto camera = parts_->camera(truth.time_s);
    const Eigen::AngleAxisd turn(camera.rotation);
    truth.camera_from_head = {turn.angle() * turn.axis(), camera.translation_mm};
    const auto skin_mm = parts_->skin(truth.weights);
    for (std::size_t c = 0; c < curve_count; ++c)
        for (const auto vertex : parts_->lines.curves[c]) truth.curves[c].push_back(camera.pixel(skin_mm[vertex]));
    for (std::size_t p = 0; p < 68; ++p) truth.points[p] = camera.pixel(skin_mm[parts_->lines.points[p]]);
    return truth;
}

}  // namespace mimik::video
