// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_certification_h
#define debond_certify_certification_h

#include <debond/certify/certificate.h>
#include <debond/program/companion.h>

namespace Debond
{
  /// The certificate of a run, as the goal of its refinement or of its result,
  /// and what is said and written of it; nothing of all this for a scene
  /// without one.
  template <int dim>
  class Certification : public RefinementGoal<dim>, public RunCompanion<dim>
  {
  public:
    /// Takes the scene on its first mesh. @p target: width relative to J, 0 for
    /// any; @p proof: limits of branch and bound. Throws BadInput if the scene
    /// can have no certificate.
    Certification(const CertificateKind                    kind,
                  const double                             target,
                  const BranchAndBoundParameters          &proof,
                  const std::shared_ptr<const Scene<dim>> &scene);

    /// Returns null if no width is asked for.
    RefinementGoal<dim> *
    goal() override
    {
      return target > 0. ? this : nullptr;
    }

    /// Makes the interval for bonds that may break, which takes longer, only if
    /// that for their branches as they are is narrow enough, or @p is_last.
    GoalOnMesh
    look(const std::shared_ptr<const Scene<dim>> &scene,
         const Solution                          &result,
         const bool                               is_last) override;

    double
    n_unknowns(const double n_cells) const override;

    /// Makes that of a success on the last mesh, unless it has one as a goal. A
    /// note of @p result says why there is none.
    void
    after(RunResult<dim> &result) override;

    void
    report(Record &record) const override;

    /// Returns a table of the sides. Keeps references.
    std::vector<OutputFile>
    files(const OutputParameters &output,
          const Scene<dim>       &scene) const override;

  private:
    /// Makes the certificate of a result, to which the latest global one adds
    /// what it knows. Throws as Certifier does.
    void
    make(const CertificateKind                    kind_of_this,
         const std::shared_ptr<const Scene<dim>> &scene,
         const Solution                          &result);

    const CertificateKind          kind;
    const double                   target;
    const BranchAndBoundParameters proof;

    std::optional<Certificate> certificate;

    /// The latest one for bonds that may break, which makes the next one
    /// narrower.
    std::optional<Certificate> latest_global;
  };
} // namespace Debond

#endif
