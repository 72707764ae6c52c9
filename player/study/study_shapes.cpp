#include "player/study/study_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/extensions.h"
#include "player/print.h"
#include "player/progress.h"
#include "player/study/processor_time.h"
#include "player/study/studies.h"
#include "systems/touch/contact_law.h"
#include "systems/touch/field_kernels.h"

namespace pliant {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 0.004;  // [m] of the punch: what the engine calibrates stiffness with
constexpr double kAround = 5.0;    // [1] radii that a profile is compared over
constexpr double kUsual = 5.0;     // [1] reach over the contact's radius that the engine takes (force_field.cpp)
constexpr Shape kShapes[] = {Shape::kPunch,    Shape::kHertz,  Shape::kGaussian,
                             Shape::kWendland, Shape::kVolume, Shape::kKelvinlet};

FieldSource source_of(Shape shape, double inner, double reach) {
  FieldSource source;
  source.amplitude = 1.0f;
  source.inv_reach2 = static_cast<float>(1 / (reach * reach));
  source.shape = shape;
  source.parameter = shape == Shape::kKelvinlet ? static_cast<float>(inner)
                     : shape == Shape::kVolume  ? 5.0f
                                                : static_cast<float>(inner * inner / (reach * reach));
  return source;
}

// [ns] a vertex whose target is computed, in the kernel that ships.
double measure(Shape shape, int batches) {
  Mesh mesh;
  mesh.vertex_count = kZoneSize;
  mesh.nx.assign(kZoneSize, 0.0f);
  mesh.ny.assign(kZoneSize, 1.0f);
  mesh.nz = mesh.py = mesh.nx;
  for (std::uint32_t v = 0; v < kZoneSize; ++v) {
    mesh.px.push_back(1e-3f * static_cast<float>(v % 12));
    mesh.pz.push_back(1e-3f * static_cast<float>(v / 12));
  }
  const FieldSource source = source_of(shape, kRadius, kUsual * kRadius);
  ZoneTargets targets{};
  double least = 1e30;
  for (int i = 0; i < batches; ++i) {
    const std::uint64_t begin = processor_ns();
    for (int k = 0; k < 200; ++k) add_targets(mesh, 0, source, true, targets);
    least = std::min(least, static_cast<double>(processor_ns() - begin) / (200.0 * kZoneSize));
  }
  return least;
}

// The force's side: P1's calibrated stiffness against the block's, and the two laws against their closed forms.
struct ForceRow {
  std::string truth;
  double model = 0.0, truth_force = 0.0;  // [N] at the same depth
  double error() const { return model / truth_force - 1; }
};

struct Blocks {
  std::vector<PressTruth> truths;
  std::vector<ForceRow> forces;
  std::string note;  // how far the block itself is off
};

Result<Blocks> press_blocks(bool quick, const Interrupt& interrupt, Progress& progress) {
  Blocks out;
  struct Wish {
    double thickness, poisson;
  };
  const std::vector<Wish> wishes =
      quick ? std::vector<Wish>{{2, 0.45}} : std::vector<Wish>{{10, 0.3}, {2, 0.3}, {2, 0.45}, {2, 0.49}, {1, 0.45}};
  constexpr double kYoung = 10e3, kDepth = 1e-4;
  double done = 0.0;
  for (const Wish& wish : wishes) {
    if (interrupt.requested()) return interrupted();
    BlockPress press{kYoung, wish.poisson, kRadius, wish.thickness * kRadius, 10 * kRadius, quick ? 2 : 4};
    auto block = press_block(press, kDepth);
    if (!block) return block.error();
    const std::string name = fmt::format("block {:g} a thick, Poisson {:g}", wish.thickness, wish.poisson);
    out.truths.push_back(block_truth(name, kRadius, *block));
    out.forces.push_back({name, calibrated_stiffness(kYoung, wish.poisson, press.thickness) * kDepth, block->force});
    if (done == 0.0) {
      const double deep = 2 * kYoung / (1 - wish.poisson * wish.poisson) * kRadius * kDepth;
      out.note = fmt::format("The first block ({}, {} tetrahedra) takes {:+.1f} % force against a half-space", name,
                             block->tets, 100 * (block->force / deep - 1));
    }
    progress.update((done += 1.0) / static_cast<double>(wishes.size()));
  }
  return out;
}

void add_laws(std::vector<ForceRow>& rows) {
  Deformable d;
  d.young = 10e3;
  d.stiffness = calibrated_stiffness(d.young, d.poisson, 0.0);
  const double plane = d.young / (1 - d.poisson * d.poisson), depth = 1e-3, ball = 0.008;
  const Motion m = motion(d, 1e-3);
  rows.push_back({"half-space, punch", contact_law(d, m, 1.0, 0.0).force(depth), 2 * plane * kRadius * depth});
  rows.push_back({"half-space, sphere", contact_law(d, m, 1.0, ball).force(depth),
                  4.0 / 3.0 * plane * std::sqrt(ball) * depth * std::sqrt(depth)});
}

// Four truths are enough for one plot; the table has them all.
bool is_drawn(const std::string& truth) {
  return truth.starts_with("half") || truth == "block 10 a thick, Poisson 0.3" ||
         truth == "block 2 a thick, Poisson 0.45";
}

std::string nearest_of(const ParetoTable& table) {
  std::string out = "The nearest shape to each truth, with its reach in contact radii:";
  for (std::size_t i = 0; i < table.rows.size();) {
    const std::string& truth = table.rows[i].group;
    const ParetoRow* least = nullptr;
    for (; i < table.rows.size() && table.rows[i].group == truth; ++i)
      if (table.rows[i].more[0] == "best" && (!least || table.rows[i].error < least->error)) least = &table.rows[i];
    out += fmt::format("{} {}, {} ({:.2g} %)", out.back() == ':' ? "" : ";", truth, least->label, 100 * least->error);
  }
  return out + ".";
}

std::string forces_of(const std::vector<ForceRow>& rows) {
  const auto less = [](const ForceRow& a, const ForceRow& b) { return std::abs(a.error()) < std::abs(b.error()); };
  const ForceRow &least = *std::min_element(rows.begin(), rows.end(), less),
                 &most = *std::max_element(rows.begin(), rows.end(), less);
  return fmt::format("The calibrated law's force is off by {:+.1f} % ({}) to {:+.1f} % ({}).", 100 * least.error(),
                     least.truth, 100 * most.error(), most.truth);
}

}  // namespace

const char* name_of(Shape shape) {
  constexpr const char* kNames[] = {"punch", "hertz", "gaussian", "wendland", "volume", "kelvinlet"};
  return kNames[static_cast<std::size_t>(shape)];
}

PressTruth punch_truth(double a) {
  return {"half-space, punch", a, [a](double r) { return r <= a ? 1.0 : 2 / kPi * std::asin(a / r); }};
}

PressTruth hertz_truth(double a) {
  return {"half-space, sphere", a, [a](double r) {
            const double q = r / a;
            if (q <= 1) return 1 - q * q / 2;
            return ((2 - q * q) * std::asin(1 / q) + std::sqrt(q * q - 1)) / kPi;
          }};
}

PressTruth block_truth(const std::string& name, double radius, const PressedBlock& block) {
  return {name, radius, [radius = block.radius, share = block.share](double r) {
            const auto above = std::upper_bound(radius.begin(), radius.end(), r);
            if (above == radius.end()) return share.back();
            if (above == radius.begin()) return share.front();
            const auto i = static_cast<std::size_t>(above - radius.begin());
            const double t = (r - radius[i - 1]) / (radius[i] - radius[i - 1]);
            return share[i - 1] + t * (share[i] - share[i - 1]);
          }};
}

std::function<double(double)> engine_share(Shape shape, double inner, double reach) {
  const FieldSource source = source_of(shape, inner, reach);
  return [source, reach](double r) {
    if (r >= reach) return 0.0;
    return static_cast<double>(share_at(source, vec3(static_cast<float>(r), 0, 0), vec3(0, 1, 0)));
  };
}

ShapeError shape_error(const std::function<double(double)>& share, const PressTruth& truth) {
  constexpr int kParts = 2000;
  const double step = kAround * truth.inner / kParts;
  double off = 0.0, size = 0.0, net = 0.0, true_net = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double r = (i + 0.5) * step, f = share(r), u = truth.share(r);
    off += (f - u) * (f - u) * r;
    size += u * u * r;
    net += f * r;
    true_net += u * r;
  }
  return {std::sqrt(off / size), net / true_net - 1};
}

double best_reach(Shape shape, const PressTruth& truth) {
  double best = 0.0, least = 1e30;
  for (double over = 1.0; over < 40.0; over *= 1.02) {
    const double error = shape_error(engine_share(shape, truth.inner, over * truth.inner), truth).profile;
    if (error < least) least = error, best = over * truth.inner;
  }
  return best;
}

Status study_shapes(OutputFolder& out, bool quick, const Interrupt& interrupt) {
  Progress progress("study shapes");
  auto blocks = press_blocks(quick, interrupt, progress);
  if (!blocks) return blocks.error();
  std::vector<PressTruth> truths{punch_truth(kRadius), hertz_truth(kRadius)};
  truths.insert(truths.end(), blocks->truths.begin(), blocks->truths.end());
  add_laws(blocks->forces);

  ParetoTable table;
  table.study = "shapes";
  table.title =
      "the surface of a press, by each shape at its best reach, against closed forms and blocks of tetrahedra";
  table.cost_name = "cost_ns_per_vertex";
  table.cost_axis = "cost [ns a vertex reached]";
  table.error_name = "profile_error";
  table.error_axis = "profile error: RMS difference over RMS [1]; below 0.01 on the edge";
  table.more = {"reach", "reach_over_radius", "volume_error"};
  table.joined = false;
  table.front_by_group = true;
  table.least_error = 0.01;
  table.most_error = 1.0;
  std::vector<double> ns;
  for (const Shape shape : kShapes) ns.push_back(measure(shape, quick ? 9 : 101));
  for (const PressTruth& truth : truths)
    for (const bool best : {true, false})
      for (std::size_t i = 0; i < std::size(kShapes); ++i) {
        const double reach = best ? best_reach(kShapes[i], truth) : kUsual * truth.inner;
        const ShapeError error = shape_error(engine_share(kShapes[i], truth.inner, reach), truth);
        if (best && is_drawn(truth.name)) table.drawn.push_back(table.rows.size());
        table.rows.push_back({fmt::format("{} {:.1f} a", name_of(kShapes[i]), reach / truth.inner),
                              ns[i],
                              error.profile,
                              truth.name,
                              {best ? "best" : "usual", fmt::format("{:.3f}", reach / truth.inner),
                               fmt::format("{:.6f}", error.volume)}});
      }
  table.sentences.push_back(nearest_of(table));
  std::string csv = "truth,model_N,true_N,force_error\n";
  for (const ForceRow& row : blocks->forces)
    csv += fmt::format("\"{}\",{:.9g},{:.9g},{:.9g}\n", row.truth, row.model, row.truth_force, row.error());
  table.sentences.push_back(forces_of(blocks->forces) + " " + blocks->note + ".");
  if (const Status done = write_text(out, "shapes_force.csv", csv); !done) return done;
  return write_study(out, table);
}

}  // namespace pliant
