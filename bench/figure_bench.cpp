// One figure of 800 x 800 pixels: the face of 150 x 150 vertices (44,402 triangles). The peer is VTK itself drawing a
// scene that stands ready, with the same samples per pixel, and reading it back: what a figure cannot cost less than.
#include <benchmark/benchmark.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "bench/bench_scan.h"
#include "figures/figure.h"
#include "figures/offscreen.h"

namespace mimik::bench {
namespace {

constexpr int side_px = 800;

geometry::Mesh face_grid() {
    constexpr std::uint32_t n = 150;
    geometry::Mesh mesh;
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t col = 0; col < n; ++col) {
            const double x = -72.0 + 144.0 * col / (n - 1), y = -100.0 + 200.0 * row / (n - 1);
            mesh.vertices_mm.emplace_back(x, y, face_height(x, y));
        }
    for (std::uint32_t row = 0; row + 1 < n; ++row)
        for (std::uint32_t col = 0; col + 1 < n; ++col) {
            const std::uint32_t a = row * n + col;
            mesh.faces.add(std::array{a, a + 1, a + n + 1, a + n});
        }
    return mesh;
}

figures::Figure one_panel(int supersampling) {
    figures::Figure figure;
    figure.panels = {{.mesh = face_grid(), .caption = "A face of 22,500 vertices"}};
    figure.panel_width_px = figure.panel_height_px = side_px;
    figure.supersampling = supersampling;
    return figure;
}

void mimik_figure(benchmark::State& state) {
    const auto page = one_panel(1);
    (void)figures::render(page);  // opens the renderer, compiles its shaders
    for (auto _ : state) benchmark::DoNotOptimize(figures::render(page));
}
BENCHMARK(mimik_figure)->Unit(benchmark::kMillisecond)->UseRealTime();

void mimik_figure_supersampled(benchmark::State& state) {
    const auto page = one_panel(2);
    (void)figures::render(page);
    for (auto _ : state) benchmark::DoNotOptimize(figures::render(page));
}
BENCHMARK(mimik_figure_supersampled)->Unit(benchmark::kMillisecond)->UseRealTime();

void mimik_figure_to_png(benchmark::State& state) {
    const auto image = figures::render(one_panel(1));
    for (auto _ : state) benchmark::DoNotOptimize(io::encode_png(image));
}
BENCHMARK(mimik_figure_to_png)->Unit(benchmark::kMillisecond)->UseRealTime();

void vtk_figure(benchmark::State& state) {
    const auto mesh = face_grid();
    vtkNew<vtkPoints> points;
    for (const auto& p : mesh.vertices_mm) points->InsertNextPoint(p.data());
    vtkNew<vtkCellArray> polygons;
    for (const auto& t : geometry::triangulate(mesh.faces)) {
        const std::array<vtkIdType, 3> corners = {t[0], t[1], t[2]};
        polygons->InsertNextCell(3, corners.data());
    }
    vtkNew<vtkPolyData> surface;
    surface->SetPoints(points);
    surface->SetPolys(polygons);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(surface);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkNew<vtkRenderer> renderer;
    renderer->AddActor(actor);
    renderer->GetActiveCamera()->ParallelProjectionOn();
    renderer->ResetCamera();
    figures::with_offscreen_window([&](vtkRenderWindow& window, const std::string&) {
        window.SetMultiSamples(8);
        window.SetSize(side_px, side_px);
        window.AddRenderer(renderer);
        window.Render();
        vtkNew<vtkUnsignedCharArray> pixels;
        for (auto _ : state) {
            window.Render();
            window.GetPixelData(0, 0, side_px - 1, side_px - 1, 0, pixels);
        }
        window.RemoveRenderer(renderer);
        renderer->ReleaseGraphicsResources(&window);
    });
}
BENCHMARK(vtk_figure)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace mimik::bench
