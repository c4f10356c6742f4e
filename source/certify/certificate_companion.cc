// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/certify/certificate_companion.h>
#include <debond/certify/certification.h>

namespace Debond
{
  namespace
  {
    class CertificateCompanion : public Companion
    {
    public:
      void
      bind(ParameterTable &table) override
      {
        table.bind_choice(
          "Certificate/Kind",
          kind,
          {{"none", CertificateKind::none},
           {"fixed state", CertificateKind::fixed_state},
           {"global", CertificateKind::global}},
          "An interval, with a proof, for the minimum of the continuous problem on the body of the mesh: global is for the least J (2D), fixed state for the least J with the bonds of each side of the contact boundary on the branch of the result");
        table.bind(
          "Certificate/Target",
          target,
          relative_target(),
          "The mesh is refined where that makes the interval narrower, from the one of Mesh on, until its width relative to J is not larger than this; 0 for the mesh as it is");
      }

      void
      check(Parameters &p, ParameterTable &table) const override
      {
        // The certificate is a goal of the refinement if it has a target, and
        // another proof beside the one of the solver.
        p.accuracy.has_goal      = target > 0.;
        p.solver.has_other_proof = kind != CertificateKind::none;
        if (target > 0. && p.solver.method == SolverMethod::euclidean_bundle)
          table.reject("Solver/Method",
                       "meshes that are refined need automatic, energy bundle "
                       "or majorise minimise",
                       {"Certificate/Target"});
        if (kind == CertificateKind::none)
          {
            table.without_effect("Certificate/Target",
                                 "is for a certificate",
                                 "Certificate/Kind");
            return;
          }
        // What doc/reference/certificate.md does not prove is refused while the
        // scene is read: bonds that bear shear, radii in the integrals, several
        // bodies, a foundation along which s is not v_nu, changes of
        // temperature whose stress is no pressure, and laws that soften
        // gradually. Bonds that lose their traction at once are those of
        // Theorem 1.
        const auto refuse = [&table](const bool                      is_so,
                                     const std::string              &reason,
                                     const std::vector<std::string> &others) {
          if (is_so)
            table.reject("Certificate/Kind", reason, others);
        };
        refuse(p.symmetry != Symmetry::none,
               "is for bodies without an axis",
               {"Symmetry"});
        refuse(p.dimension != 2 && kind == CertificateKind::global,
               "is for plane bodies",
               {"Dimension"});
        refuse(!p.load_path.factors.empty() || !p.load_path.dead_loads.empty(),
               "is for a single load",
               {"Load path/Factors", "Load path/Dead loads"});
        for (const std::string entry : {"Mesh/Cuts", "Mesh/Interfaces"})
          refuse(!table.get(entry).empty(),
                 "needs one body, of which " + entry + " makes several",
                 {});
        refuse(!p.supports.normal.empty() || !p.supports.normals.empty(),
               "needs the body's own normals",
               {"Boundary conditions/Foundation normal"});
        refuse(!p.loads.temperature_change.empty() && p.materials.has_axes(),
               "needs materials that expand alike along all axes, if there is "
               "a temperature change",
               {"Loads/Temperature change"});
        refuse(!p.law.pieces.empty() && AdhesiveLaw(p.law.pieces).softens(),
               "needs bonds whose traction does not fall but at once, these "
               "soften",
               {"Contact law/Law"});
        refuse(p.friction.is_somewhere(),
               "is for bodies without friction",
               {"Contact law/Friction bound",
                "Contact law/Friction coefficient"});
        refuse(p.shear.is_somewhere,
               "needs bonds along the normal alone",
               {"Contact law/Tangential displacement"});
      }

      std::unique_ptr<RunCompanion<2>>
      begin(const SolverParameters                &solver,
            const std::shared_ptr<const Scene<2>> &scene) const override
      {
        return std::make_unique<Certification<2>>(kind,
                                                  target,
                                                  solver.proof,
                                                  scene);
      }

      std::unique_ptr<RunCompanion<3>>
      begin(const SolverParameters                &solver,
            const std::shared_ptr<const Scene<3>> &scene) const override
      {
        return std::make_unique<Certification<3>>(kind,
                                                  target,
                                                  solver.proof,
                                                  scene);
      }

    private:
      CertificateKind kind = CertificateKind::none;

      /// Of the width relative to J; 0 for any.
      double target = 0.;
    };
  } // namespace



  std::unique_ptr<Companion>
  make_certificate_companion()
  {
    return std::make_unique<CertificateCompanion>();
  }
} // namespace Debond
