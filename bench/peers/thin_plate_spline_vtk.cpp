#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkThinPlateSplineTransform.h>

#include "bench/peers/thin_plate_spline_peer.h"

namespace mimik::peers {
namespace {

void fill(vtkPoints* into, std::span<const geometry::Point> points_mm) {
    into->SetDataTypeToDouble();
    into->SetNumberOfPoints(static_cast<vtkIdType>(points_mm.size()));
    for (std::size_t i = 0; i < points_mm.size(); ++i) into->SetPoint(static_cast<vtkIdType>(i), points_mm[i].data());
}

class Peer final : public ThinPlateSplinePeer {
public:
    Peer(std::span<const geometry::Point> source_mm, std::span<const geometry::Point> target_mm) {
        vtkNew<vtkPoints> source, target;
        fill(source, source_mm);
        fill(target, target_mm);
        spline_->SetSigma(1.0);
        spline_->SetBasisToR2LogR();
        spline_->SetSourceLandmarks(source);
        spline_->SetTargetLandmarks(target);
        spline_->Update();
    }
    [[nodiscard]] std::vector<geometry::Point> apply(std::span<const geometry::Point> points_mm) const override {
        std::vector<geometry::Point> moved(points_mm.size());
        for (std::size_t i = 0; i < points_mm.size(); ++i)
            spline_->InternalTransformPoint(points_mm[i].data(), moved[i].data());
        return moved;
    }

private:
    vtkNew<vtkThinPlateSplineTransform> spline_;
};

}  // namespace

std::unique_ptr<ThinPlateSplinePeer> make_vtk_peer(std::span<const geometry::Point> source_mm,
                                                   std::span<const geometry::Point> target_mm) {
    return std::make_unique<Peer>(source_mm, target_mm);
}

}  // namespace mimik::peers
