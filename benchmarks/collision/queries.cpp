#include "queries.h"

#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

namespace kaboum::collide {

std::vector<Configuration> record_queries(const Configuration& start, const Configuration& goal,
                                          double range,
                                          const std::function<bool(const Configuration&)>& valid,
                                          std::size_t wanted, std::size_t& solved) {
  namespace ob = ompl::base;
  namespace og = ompl::geometric;
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  ompl::RNG::setSeed(1);
  std::vector<Configuration> queries;
  solved = 0;
  std::size_t asked = 0;
  const auto dimension = static_cast<unsigned>(start.size());
  for (int attempt = 0; attempt < 100 && queries.size() < wanted; ++attempt) {
    auto space = std::make_shared<ob::RealVectorStateSpace>(dimension);
    space->setBounds(-range, range);
    og::SimpleSetup setup(space);
    setup.setStateValidityChecker([&](const ob::State* state) {
      const double* q = state->as<ob::RealVectorStateSpace::StateType>()->values;
      Configuration configuration(q, q + dimension);
      const bool result = valid(configuration);
      ++asked;
      if (queries.size() < wanted) queries.push_back(std::move(configuration));
      return result;
    });
    ob::ScopedState<> from(space), to(space);
    for (unsigned i = 0; i < dimension; ++i) {
      from[i] = start[i];
      to[i] = goal[i];
    }
    setup.setStartAndGoalStates(from, to);
    setup.getSpaceInformation()->setStateValidityCheckingResolution(0.005);
    setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
    // A plan is finished where that is possible, though no more of its queries are kept.
    const ob::PlannerTerminationCondition enough([&] { return asked >= 200 * wanted; });
    if (setup.solve(enough) == ob::PlannerStatus::EXACT_SOLUTION) ++solved;
  }
  return queries;
}

}  // namespace kaboum::collide
