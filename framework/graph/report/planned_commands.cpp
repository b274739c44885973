#include "framework/graph/report/planned_commands.h"

namespace fovea::graph {

std::optional<CommandCounts> plannedCommands(const Plan& plan, const Level& level, uint32_t pass) {
  const PassDeclaration& declaration = *plan.graph->passes[pass].declaration;
  if (declaration.stepsByFrame || declaration.kind == PassKind::Host || plan.steps.empty() ||
      plan.steps[pass].empty())
    return std::nullopt;
  CommandCounts counts;
  counts.barriers = pass == level.passes.front() && !level.before.empty() ? 1 : 0;
  for (const PlannedStep& step : plan.steps[pass]) {
    const StepSpec& spec = declaration.steps[step.step];
    const bool dispatch = spec.action == StepSpec::Action::Dispatch;
    if (step.host || (dispatch && spec.sizing == StepSpec::Size::Manual)) return std::nullopt;
    if (step.before) ++counts.barriers;
    if (dispatch) {
      ++(spec.sizing == StepSpec::Size::Indirect ? counts.indirectDispatches : counts.dispatches);
    } else if (spec.action == StepSpec::Action::Fullscreen) {
      ++counts.draws;
      ++counts.renderings;
    } else {
      ++counts.transfers;
    }
  }
  return counts;
}

}  // namespace fovea::graph
