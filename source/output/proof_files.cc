// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/output/proof_files.h>

#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>

namespace Debond
{
  namespace
  {
    using Json = nlohmann::ordered_json;



    /// A file beside @p path, by its name and the checksum of its bytes.
    Json
    reference_to(const std::string &name, const std::string &path)
    {
      std::ifstream     file(std::filesystem::path(path).replace_filename(name),
                         std::ios::binary);
      const std::string bytes(std::istreambuf_iterator<char>(file), {});
      return {{"file", name},
              {"crc32",
               crc32_z(0,
                       reinterpret_cast<const unsigned char *>(bytes.data()),
                       bytes.size())}};
    }



    void
    write_json(const std::string &path, const std::function<Json()> &content)
    {
      write_atomically(path,
                       [&](std::ostream &out) { out << content() << '\n'; });
    }



    /// The numbers of the terms of problem.json that bonds with several
    /// unknowns have; those without energy have none.
    std::map<unsigned int, unsigned int>
    terms_of_bonds(const SeparableEnergy &phi)
    {
      std::map<unsigned int, unsigned int> terms;
      for (unsigned int i = 0; !phi.bonds.empty() && i < phi.f.size(); ++i)
        if (phi.f[i].size() > 1 || !phi.f[i][0].is_flat())
          terms.emplace(i, static_cast<unsigned int>(terms.size()));
      return terms;
    }



    Json
    pieces_of(const PiecewiseEnergy &f)
    {
      Json result = Json::array();
      for (unsigned int k = 0; k < f.size(); ++k)
        {
          const auto &piece = f[k];
          result.push_back(
            {piece.curvature,
             piece.slope,
             std::isfinite(piece.lower) ? Json(piece.lower) : Json()});
          if (piece.decay > 0.)
            result.back().push_back(piece.decay);
        }
      return result;
    }



    Json
    terms_of(const SeparableEnergy &phi)
    {
      Json result = Json::array();
      if (phi.bonds.empty())
        {
          for (unsigned int i = 0; i < phi.f.size(); ++i)
            if (phi.f[i].size() > 1 || !phi.f[i][0].is_flat())
              result.push_back(
                {{"unknown", i}, {"pieces", pieces_of(phi.f[i])}});
          return result;
        }
      const auto terms = terms_of_bonds(phi);
      for (const auto &[bond, unused] : terms)
        {
          const double energy = phi.f[bond].largest_value();
          result.push_back(
            {{"unknowns", Json::array()},
             {"stiffness", Json::array()},
             {"energy", std::isfinite(energy) ? Json(energy) : Json()}});
        }
      for (unsigned int j = 0; j < phi.bonds.size(); ++j)
        if (const auto term = terms.find(phi.bonds[j]); term != terms.end())
          {
            result[term->second]["unknowns"].push_back(j);
            result[term->second]["stiffness"].push_back(
              phi.weights(j) * phi.f[term->first][0].curvature);
          }
      return result;
    }



    Json
    friction_of(const Kinks &kinks)
    {
      Json result = Json::array();
      for (Eigen::Index i = 0; i < kinks.weight.size(); ++i)
        if (const auto group = kinks.group(i);
            kinks.has(i) && group.back() >= i)
          result.push_back(
            {{"unknowns", group},
             {"weight", kinks.weight(i)},
             {"place", json_numbers(Eigen::VectorXd(kinks.place(group)))}});
      return result;
    }



    /// The rounds and the tree of a record.
    class ProofWriter
    {
    public:
      explicit ProofWriter(const RecordedProof &proof)
        : nodes(proof.nodes)
        , pairs(proof.problem.phi.kinks().pairs())
        , partner(proof.problem.phi.kinks().partner)
        , n(proof.problem.g.size())
        , terms(terms_of_bonds(proof.problem.phi))
      {
        for (const auto &[bond, unused] : terms)
          if (std::isfinite(proof.problem.phi.f[bond].largest_value()))
            undecided.insert(bond);
        add_node(0, {{}, -infinity}, undecided);
      }

      Json rounds = Json::array(), tree = Json::array();

    private:
      const ProofRecord                         &nodes;
      const std::vector<Eigen::Index>            pairs, partner;
      const Eigen::Index                         n;
      const std::map<unsigned int, unsigned int> terms;
      std::set<unsigned int>                     undecided;

      /// An entry of the tree with which a node may end, and the bound that it
      /// gives.
      struct Ending
      {
        Json   entry;
        double value;

        void
        take_if_better(const Ending &other)
        {
          if (other.value >= value)
            *this = other;
        }
      };

      /// @p ending is the best one from the nodes that this is a part of, and
      /// @p bonds are those with both states.
      void
      add_node(const unsigned int     number,
               Ending                 ending,
               std::set<unsigned int> bonds)
      {
        const auto node = nodes.find(number);
        if (node == nodes.end())
          {
            tree.push_back(ending.entry);
            return;
          }
        const NodeRecord &found = node->second;
        std::size_t       last  = 0;
        for (const ProofRound &round : found.rounds)
          {
            last = rounds.size();
            add_round(round);
            ending.take_if_better({{"leaf", last}, round.value});
            if (round.lower.size() == 0)
              continue;
            add_cut(last, round, bonds);
            if ((round.lower.array() > round.upper.array()).any())
              return;
          }
        if (!found.unknown)
          {
            tree.push_back(ending.entry);
            return;
          }
        const unsigned int unknown = *found.unknown;
        if (unknown < n)
          tree.push_back({"split", unknown, found.split});
        else
          {
            const auto bond = static_cast<unsigned int>(unknown - n);
            tree.push_back({"states", terms.at(bond)});
            bonds.erase(bond);
          }
        for (const unsigned int half : {0, 1})
          {
            Ending of_half = ending;
            of_half.take_if_better({unknown < n ?
                                      Json({"grow", last, unknown}) :
                                      Json({"leaf", last}),
                                    found.half_bounds[half]});
            add_node(found.halves[half], of_half, bonds);
          }
      }

      void
      add_round(const ProofRound &round)
      {
        rounds.push_back(
          {{"D", json_numbers(round.D)}, {"x", json_numbers(round.x)}});
        // Planes without slope will do for the root.
        const Eigen::VectorXd forces =
          round.forces.size() > 0 ? round.forces : Eigen::VectorXd::Zero(n);
        for (const Eigen::Index i : pairs)
          rounds.back()["forces"].push_back({forces(i), forces(partner[i])});
      }

      /// Takes the bonds that are decided from @p bonds.
      void
      add_cut(const std::size_t       number,
              const ProofRound       &round,
              std::set<unsigned int> &bonds)
      {
        Json hold = Json::array(), broken = Json::array();
        for (auto bond = bonds.begin(); bond != bonds.end();)
          {
            const bool is_broken = round.lower(n + *bond) > 0.,
                       holds     = round.upper(n + *bond) < 1.;
            if (holds)
              hold.push_back(terms.at(*bond));
            if (is_broken)
              broken.push_back(terms.at(*bond));
            bond = holds || is_broken ? bonds.erase(bond) : std::next(bond);
          }
        tree.push_back({"cut",
                        number,
                        json_numbers(round.lower.head(n)),
                        json_numbers(round.upper.head(n)),
                        hold,
                        broken});
      }
    };
  } // namespace



  Json
  json_numbers(const VectorView &numbers)
  {
    Json result = Json::array();
    for (const double number : numbers)
      result.push_back(std::isfinite(number) ? Json(number) : Json());
    return result;
  }



  bool
  has_format(const DiscreteProblem &problem)
  {
    return problem.phi.bonds.empty() || problem.phi.is_piecewise_quadratic();
  }



  void
  write_problem(const DiscreteProblem &problem, const std::string &path)
  {
    write_json(path, [&]() -> Json {
      return {{"format", "debond problem 1"},
              {"S", reference_to("S.mtx", path)},
              {"g", json_numbers(problem.g)},
              {"c_0", problem.c_0},
              {"upper", json_numbers(problem.upper)},
              {"terms", terms_of(problem.phi)},
              {"friction", friction_of(problem.phi.kinks())}};
    });
  }



  void
  write_proof(const RecordedProof         &proof,
              const std::array<double, 2> &interval,
              const std::string           &path)
  {
    // Who checks the ends rounds them to doubles outwards, even without loads,
    // where J is 0 and nothing else rounds.
    write_json(path, [&]() -> Json {
      const ProofWriter tree(proof);
      return {{"format", "debond proof 1"},
              {"problem", reference_to("problem.json", path)},
              {"state",
               json_numbers(proof.state.cwiseMin(proof.problem.upper))},
              {"interval",
               {std::nextafter(interval[0], -infinity),
                std::nextafter(interval[1], infinity)}},
              {"rounds", tree.rounds},
              {"tree", tree.tree}};
    });
  }
} // namespace Debond
