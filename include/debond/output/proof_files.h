// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_proof_files_h
#define debond_output_proof_files_h

#include <debond/optimization/global/proof_record.h>

#include <nlohmann/json.hpp>

#include <array>
#include <string>

namespace Debond
{
  /// Numbers in the fewest digits that give them back; null is infinite.
  nlohmann::ordered_json
  json_numbers(const VectorView &numbers);

  /// Returns whether write_problem() has words for all terms of the problem:
  /// bonds that shear have to break at once.
  bool
  has_format(const DiscreteProblem &problem);

  /// Writes problem.json, which names S.mtx in the same folder, where it has to
  /// be. See doc/reference/proofs.md. As all functions of this file it throws
  /// what write_atomically() throws, and is to be called by all ranks.
  void
  write_problem(const DiscreteProblem &problem, const std::string &path);

  /// Writes proof.json, which names problem.json in the same folder, and claims
  /// that the minimum is in the @p interval.
  void
  write_proof(const RecordedProof         &proof,
              const std::array<double, 2> &interval,
              const std::string           &path);
} // namespace Debond

#endif
