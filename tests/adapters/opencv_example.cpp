// A range image and a photograph of OpenCV's go through Mimik and back, without files.
#include <cmath>
#include <limits>

#include "adapters/opencv.h"
#include "geometry/spikes.h"
#include "tests/adapters/example.h"

using namespace mimik;
using namespace mimik::adapters;

namespace {

/// Mimik's cleaning finds the spike of a range image of OpenCV's.
void find_a_spike() {
    cv::Mat image(20, 30, CV_32FC3);
    for (int row = 0; row < image.rows; ++row)
        for (int col = 0; col < image.cols; ++col)
            image.at<cv::Vec3f>(row, col) = {static_cast<float>(col), static_cast<float>(image.rows - 1 - row), 0};
    image.at<cv::Vec3f>(4, 7)[2] = 50;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    image.at<cv::Vec3f>(19, 0) = {nan, nan, nan};

    Remarks remarks;
    const auto scan = range_scan_from(image, remarks);
    expect(scan.rows == 20 && scan.cols == 30, "the lattice is the image's");
    expect(!scan.valid(0), "NaN is what was not measured, the lowest row is the first");
    const auto spikes = geometry::find_spikes(scan, geometry::scan_neighbours(scan), 4.0);
    expect(spikes[(19 - 4) * 30 + 7] == 1, "the spike is found where it stands");
    const cv::Mat back = to_opencv(scan, remarks);
    expect(back.type() == CV_64FC3 && back.at<cv::Vec3d>(4, 7)[2] == 50, "and the image comes back");
    expect(std::isnan(back.at<cv::Vec3d>(19, 0)[1]), "with what was not measured");
    expect(remarks.empty(), "nothing is lost on the way");

    image.at<cv::Vec3f>(0, 0)[2] = std::numeric_limits<float>::infinity();
    expect(
        !range_scan_from(image, remarks).valid(19 * 30) && says(remarks, "1 point with some finite coordinates counts"),
        "half a point is counted");
    expect(refused([&] { (void)range_scan_from(cv::Mat(2, 2, CV_16UC1), remarks); }, "CV_64FC3"), "depth is refused");
    expect(refused([&] { (void)to_opencv(geometry::RangeScan(), remarks); }, "lattice"), "a bare cloud is refused");
}

void photographs_keep_their_colours() {
    cv::Mat photograph(2, 3, CV_8UC3, cv::Scalar(10, 20, 30));  // blue, green, red
    photograph.at<cv::Vec3b>(0, 2) = {1, 2, 3};
    Remarks remarks;
    const auto image = image_from(photograph, remarks);
    expect(image.width == 3 && image.height == 2, "the size is the same");
    expect(image.rgb[0] == 30 && image.rgb[2] == 10 && image.rgb[6] == 3, "blue first becomes red first");
    const cv::Mat back = to_opencv(image);
    expect(back.at<cv::Vec3b>(0, 2) == photograph.at<cv::Vec3b>(0, 2), "and comes back");
    expect(image_from(cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)), remarks).rgb == std::vector<std::uint8_t>{9, 9, 9},
           "grey becomes RGB");
    expect(remarks.empty(), "nothing is lost on the way");
    (void)image_from(cv::Mat(2, 2, CV_8UC4, cv::Scalar(1, 2, 3, 128)), remarks);
    expect(says(remarks, "transparency of 4 pixels"), "transparency is left out with a word");
    expect(refused([&] { (void)image_from(cv::Mat(2, 2, CV_16UC3), remarks); }, "1 / 257"), "16 bits are refused");
}

}  // namespace

int main() {
    find_a_spike();
    photographs_keep_their_colours();
    std::cout << "OpenCV: a range image and a photograph went through Mimik and back\n";
}
