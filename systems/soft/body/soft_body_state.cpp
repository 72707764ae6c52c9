#include "systems/soft/body/soft_body_state.h"

#include <algorithm>
#include <cmath>

#include "runtime/assert.h"
#include "runtime/long_work.h"
#include "systems/soft/body/tissue_material.h"
#include "systems/soft/fem/passive_step.h"
#include "systems/soft/local/dent_spring.h"
#include "systems/soft/local/smearing_surface.h"

namespace pliant {
namespace {

// Steps from rest, so long that inertia is negligible; the remaining motion is far below visibility.
constexpr double kSettleStep = 0.1;  // [s]
constexpr int kSettleSteps = 40;
constexpr double kSettled = 1e-9;  // [1] of the body's size

bool has_handle_nodes(const TetMesh& tets, const Handle6* handle) {
  return handle != nullptr && tets.handle_count > 0;
}

// Slaved nodes have no rows; tied ones, and handle nodes without a handle, do.
std::uint32_t moving_nodes(const TetMesh& tets, const Handle6* handle) {
  const bool slaved = has_handle_nodes(tets, handle) && handle->attachment == Attachment::kSlave;
  return slaved ? tets.free_count : tets.rigid_begin();
}

dvec3 box_size(const TetMesh& tets);

std::optional<RigidParts> parts_of(const TetMesh& tets, const Tissue& tissue, const Pose& placement) {
  if (tets.rigid_counts.empty()) return std::nullopt;
  return RigidParts(tets, tissue, box_size(tets), placement);
}

std::unique_ptr<LinearSolver> with_parts(std::unique_ptr<LinearSolver> tissue, const std::optional<RigidParts>& parts) {
  if (!parts) return tissue;
  return std::make_unique<PartsSolver>(std::move(tissue), *parts);
}

dvec3 box_size(const TetMesh& tets) {
  dvec3 least = tets.nodes.front(), most = least;
  for (const dvec3 node : tets.nodes) least = glm::min(least, node), most = glm::max(most, node);
  return most - least;
}

}  // namespace

SoftBodyState::SoftBodyState(const TetMesh& tets, const Mesh& surface, const SoftBody& body, const Handle6* handle,
                             const Pose& placement, SolverKind solver)
    : SoftBodyState(tets, surface, body, handle, placement, make_solver(solver, moving_nodes(tets, handle))) {}

SoftBodyState::SoftBodyState(const TetMesh& tets, const Mesh& surface, const SoftBody& body, const Handle6* handle,
                             const Pose& placement, std::unique_ptr<LinearSolver> solver)
    : tets_(tets),
      damping_{body.rayleigh[0], body.rayleigh[1]},
      tissue_(tets, material_of(body), moving_nodes(tets, handle)),
      parts_(parts_of(tets, tissue_, placement)),
      solver_(with_parts(solver_of(tissue_, std::move(solver)), parts_), tissue_.inner(),
              has_handle_nodes(tets, handle), parts_ ? parts_->rows() : 0) {
  ASSERT(!parts_ || !tissue_.large_strain());
  ASSERT(tets.embedding.size() == surface.vertex_count);
  placed_ = placement.rotation;
  collision_mesh = &surface;
  friction_static = body.friction_static;
  friction_sliding = body.friction_sliding;

  if (has_handle_nodes(tets, handle)) {
    const std::uint32_t first = tets.free_count, count = tets.handle_count;
    settings_ = *handle;
    handle_.emplace(std::span(tets.nodes).subspan(first, count), std::span(tissue_.mass()).subspan(first, count),
                    box_size(tets), placement);
    tie_.emplace(handle->attachment, material_of(body), tissue_, first, parts_ ? &*parts_ : nullptr);
    for (std::uint32_t i = 0; i < tets.pinned_begin(); ++i) {
      mass_ += tissue_.mass()[i];
      balance_ += tissue_.mass()[i] * (tets.nodes[i] - handle_->centre());
    }
    balance_ /= mass_;
  }
  if (!handle_ && !parts_) choose_step(body.integrator);
  for (std::size_t i = 0; i < tets.nodes.size(); ++i) {
    tissue_.position()[i] = placement.to_world(tets.start.empty() ? tets.nodes[i] : tets.start[i]);
    tissue_.velocity()[i] = dvec3(0);
  }
  tissue_.rest_here();
  velocity_ = Vector::Zero(size());
  if (body.contact == SoftContact::kSplit) smear();
  refresh_surface(tissue_.position(), surface_position);
  surface_velocity.assign(surface_position.size(), dvec3(0));
}

SoftBodyState::~SoftBodyState() = default;

// Weights are of the shape in which the surface is embedded: that under gravity, if the body keeps its shape.
void SoftBodyState::smear() {
  if (tets_.samples.empty()) return;
  smearing_ = std::make_unique<const SmearingSurface>(tets_, tissue_.material().poisson);
}

void SoftBodyState::set_dent_law(const Deformable& law, double T) {
  dent_ = std::make_unique<const DentSpring>(law, T);
  friction_static = law.friction_static, friction_sliding = law.friction_sliding;
}

void SoftBodyState::free_step(double T, dvec3 gravity) {
  T_ = T;
  if (quasi_static()) std::fill(tissue_.velocity().begin(), tissue_.velocity().end(), dvec3(0));
  tissue_.assemble(stage_ * T, gravity);
  solver_.place(tissue_.position());
  if (parts_) parts_->assemble(tissue_, parts_fixed_);
  if (handle_) {
    tie_->assemble(tissue_, *handle_, T, gravity);
    couple(T, gravity);
    tie_->add_to_handle(coupling_step_.matrix, coupling_step_.right + T * carry_);
    solvable_ = solver_.factorise(tissue_.inner(), tie_->border(), tie_->corner(), tie_->right(), velocity_);
    separate_tissue(T);
  } else if (parts_) {
    Vector right(size());
    right << tissue_.right().head(part_row(0)), parts_->right();
    solvable_ = solver_.factorise(tissue_.inner(), {}, Matrix6::Zero(), right, velocity_);
  } else {
    solvable_ = solver_.factorise(tissue_.inner(), {}, Matrix6::Zero(), tissue_.right(), velocity_);
  }
  if (quasi_static()) velocity_ *= stage_;
  if (stages_) stages_->begin(tissue_, T, gravity, velocity_);
  note_free_motion();
}

void SoftBodyState::note_free_motion() {
  if (smearing_) free_velocity_ = velocity_;
  move_surface(surface_velocity);
}

void SoftBodyState::move_surface(std::vector<dvec3>& out) const {
  std::vector<dvec3> of_nodes(tets_.node_count());
  for (std::uint32_t i = 0; i < of_nodes.size(); ++i) of_nodes[i] = node_velocity(i, velocity_);
  refresh_surface(of_nodes, out);
}

// S and its right-hand side, without the parts that are not tissue.
void SoftBodyState::separate_tissue(double T) {
  if (!solvable_) {
    tissue_matrix_.setZero();
    tissue_wrench_.setZero();
    return;
  }
  tissue_matrix_ = solver_.reduced() - handle_mass_;
  tissue_matrix_.diagonal() -= coupling_step_.matrix;
  tissue_wrench_ =
      (solver_.reduced_right() - coupling_step_.right - (handle_mass_ + tissue_matrix_) * start_) / T - handle_load_;
}

void SoftBodyState::start_with(dvec3 velocity) {
  for (std::uint32_t i = 0; i < (parts_ ? tets_.pinned_begin() : tissue_.moving()); ++i)
    tissue_.velocity()[i] = velocity;
  for (std::size_t part = 0; parts_ && part < parts_->count(); ++part)
    (*parts_)[part].set_velocity(join(velocity, dvec3(0)));
}

void SoftBodyState::set_material(const TissueMaterial& material) {
  damping_ = {material.alpha, material.beta};
  tissue_.set_material(material);
  if (tie_) tie_->set_material(tissue_.material());
  if (smearing_) smear();
  if (dent_) friction_static = dent_->deformable.friction_static, friction_sliding = dent_->deformable.friction_sliding;
}

void SoftBodyState::halt() {
  velocity_.setZero();
  std::fill(tissue_.velocity().begin(), tissue_.velocity().end(), dvec3(0));
  std::fill(surface_velocity.begin(), surface_velocity.end(), dvec3(0));
  if (handle_) handle_->set_velocity(Vector6::Zero());
  if (parts_) parts_->set_velocity(Vector::Zero(parts_->rows()));
}

void SoftBodyState::settle(dvec3 gravity) {
  if (!handle_) return;
  const RigidMotion there = handle_->motion();
  tissue_.keep_relaxed(true);
  parts_fixed_ = true;  // no joint holds them yet
  const double small = kSettled * length(box_size(tets_));
  for (int i = 0; i < kSettleSteps; ++i) {
    check_in();
    prescribe_handle(there);
    free_step(kSettleStep, gravity);
    if (!solvable_ || !velocity_.allFinite()) break;  // the first step will report it
    const double moved = kSettleStep * velocity_.lpNorm<Eigen::Infinity>();
    advance(kSettleStep);
    halt();
    if (moved < small) break;
  }
  halt();
  parts_fixed_ = false;
  tissue_.keep_relaxed(false);
  prescribed_.reset();
}

void SoftBodyState::unsettle() {
  const Pose pose = handle_->object_pose();
  for (std::size_t i = 0; i < tets_.nodes.size(); ++i) tissue_.position()[i] = pose.to_world(tets_.nodes[i]);
  place_parts(pose);
  tissue_.rest_here();
  refresh_surface(tissue_.position(), surface_position);
}

// The motion that is only carried: with the handle, or of the centre of mass of what nothing holds.
std::vector<dvec3> SoftBodyState::carried_motion() const {
  std::vector<dvec3> out(tets_.node_count(), dvec3(0));
  if (handle_) {
    const Vector6 w = velocity_.tail<6>();
    const dvec3 centre = handle_->motion().pose.position;
    for (std::uint32_t i = 0; i < tets_.pinned_begin(); ++i)
      out[i] = linear(w) + cross(angular(w), tissue_.position()[i] - centre);
  } else if (tissue_.moving() == tets_.node_count()) {
    dvec3 momentum(0);
    double mass = 0.0;
    for (std::uint32_t i = 0; i < tissue_.moving(); ++i)
      momentum += tissue_.mass()[i] * node_velocity(i, velocity_), mass += tissue_.mass()[i];
    std::fill(out.begin(), out.end(), momentum / mass);
  }
  return out;
}

void SoftBodyState::keep_passive(double T) {
  const std::vector<dvec3> carried = carried_motion();
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(tissue_.moving());
  Vector rigid(rows);
  for (Eigen::Index i = 0; i < rows; ++i) rigid[i] = carried[static_cast<std::size_t>(i / 3)][static_cast<int>(i % 3)];
  const Vector d = velocity_.head(rows) - rigid;
  const double share = passive_share(tissue_, carried, d / (quasi_static() ? stage_ : 1.0),
                                     handle_ ? tets_.free_count : tissue_.moving(), quasi_static() ? stage_ * T : T);
  shortened_ = share < 1.0;
  if (shortened_) velocity_.head(rows) = rigid + share * d;
}

void SoftBodyState::advance(double T) {
  shortened_ = false;
  if (staged()) return advance_stages(T);
  if (tissue_.large_strain() && solvable_ && velocity_.allFinite()) keep_passive(T);
  std::vector<dvec3>&x = tissue_.position(), &v = tissue_.velocity();
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
    v[i] = node_velocity(i, velocity_);
    x[i] += T * v[i];
  }
  if (handle_) {
    handle_->set_velocity(velocity_.tail<6>());
    handle_->advance(T);
    velocity_.tail<6>() = handle_->motion().velocity;
    for (std::uint32_t i = tissue_.moving(); i < tets_.rigid_begin(); ++i) {
      x[i] = handle_->motion().pose.position + handle_->arm(i - tets_.free_count);
      v[i] = node_velocity(i, velocity_);
    }
  }
  if (parts_) advance_parts(T);
  tissue_.end_step(T);
  refresh_surface(x, surface_position);
}

void SoftBodyState::advance_parts(double T) {
  const Eigen::Index rows = parts_->rows();
  parts_->set_velocity(velocity_.segment(part_row(0), rows));
  for (std::size_t part = 0; part < parts_->count(); ++part) (*parts_)[part].advance(T);
  velocity_.segment(part_row(0), rows) = parts_->velocity();
  for (std::uint32_t i = tets_.rigid_begin(); i < tets_.pinned_begin(); ++i) {
    tissue_.position()[i] = (*parts_)[parts_->of(i)].motion().pose.position + parts_->arm(i);
    tissue_.velocity()[i] = node_velocity(i, velocity_);
  }
}

void SoftBodyState::place_parts(const Pose& object) {
  for (std::size_t part = 0; parts_ && part < parts_->count(); ++part) (*parts_)[part].place(object);
}

std::optional<Pose> SoftBodyState::part_pose(int part, double T) const {
  if (part < 0 || part >= rigid_count()) return std::nullopt;
  RigidHandle after = rigid_part(part);
  if (T > 0.0) {
    after.set_velocity(velocity_.segment<6>(part_row(part)));
    after.advance(T);
  }
  return after.object_pose();
}

dvec3 SoftBodyState::node_velocity(std::uint32_t node, const Vector& velocity) const {
  if (node < tissue_.moving()) {
    const double* v = velocity.data() + 3 * node;
    return {v[0], v[1], v[2]};
  }
  if (!slaved(node)) return dvec3(0);
  const Ride on = ride(node);
  const Vector6 w = velocity.segment<6>(on.row);
  return linear(w) + cross(angular(w), on.arm);
}

void SoftBodyState::refresh_surface(const std::vector<dvec3>& of_nodes, std::vector<dvec3>& of_surface) const {
  of_surface.resize(tets_.embedding.size());
  for (std::size_t s = 0; s < of_surface.size(); ++s) {
    const Embedding& place = tets_.embedding[s];
    const Tet& tet = tets_.tets[place.tet];
    of_surface[s] = place.weight[0] * of_nodes[tet[0]] + place.weight[1] * of_nodes[tet[1]] +
                    place.weight[2] * of_nodes[tet[2]] + place.weight[3] * of_nodes[tet[3]];
  }
}

LocalElasticity SoftBodyState::elasticity() const {
  return {tissue_.material().young, tissue_.material().poisson};
}

dvec3 SoftBodyState::free_velocity(const SmearedLoad& load) const {
  dvec3 sum(0);
  for (const SmearedNode& part : load.nodes) sum += part.weight * node_velocity(part.node, free_velocity_);
  return sum;
}

// As for a rigid body: each node gets its share by mass of the force, and of the angular acceleration.
void SoftBodyState::load(dvec3 force, dvec3 torque, Rows& column) const {
  const std::vector<dvec3>& x = tissue_.position();
  const std::vector<double>& mass = tissue_.mass();
  double whole = 0.0;
  dvec3 centre(0);
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) whole += mass[i], centre += mass[i] * x[i];
  if (!(whole > 0.0)) return;
  centre /= whole;
  dmat3 inertia(0);
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
    const dvec3 r = x[i] - centre;
    inertia += mass[i] * (dot(r, r) * dmat3(1) - glm::outerProduct(r, r));
  }
  const bool turns = torque != dvec3(0) && glm::determinant(inertia) > 0.0;
  const dvec3 acceleration = force / whole, turning = turns ? glm::inverse(inertia) * torque : dvec3(0);
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
    const dvec3 f = mass[i] * (acceleration + cross(turning, x[i] - centre));
    for (int k = 0; k < 3; ++k) column(3 * i + k, 0) += f[k];
  }
}

void SoftBodyState::place(const Pose& pose) {
  for (std::size_t i = 0; i < tets_.nodes.size(); ++i) tissue_.position()[i] = pose.to_world(tets_.nodes[i]);
  place_parts(pose);
  tissue_.rest_here();
  halt();
  refresh_surface(tissue_.position(), surface_position);
}

// Lumped masses; those of the handle's nodes belong to the handle, however they are attached.
void SoftBodyState::weigh(const Rows& x, Rows& out) const {
  out.resize(x.rows(), x.cols());
  const std::uint32_t tissue_only = handle_ ? tets_.free_count : tissue_.moving();
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i)
    out.middleRows<3>(3 * i) = (i < tissue_only ? tissue_.mass()[i] : 0.0) * x.middleRows<3>(3 * i);
  for (std::size_t part = 0; parts_ && part < parts_->count(); ++part)
    out.middleRows<6>(part_row(static_cast<int>(part))).noalias() =
        (*parts_)[part].mass_matrix() * x.middleRows<6>(part_row(static_cast<int>(part)));
  if (handle_) out.bottomRows<6>().noalias() = handle_mass_ * x.bottomRows<6>();
}

Vector SoftBodyState::starting_velocity() const {
  Vector out(size());
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i)
    for (int k = 0; k < 3; ++k) out[3 * i + k] = tissue_.velocity()[i][k];
  if (parts_) out.segment(part_row(0), parts_->rows()) = parts_->velocity();
  if (handle_) out.tail<6>() = start_;
  return out;
}

}  // namespace pliant
