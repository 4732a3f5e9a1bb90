#include "server/experiments/explain/explanation_words.hpp"

#include <cstdio>

namespace overfly::server::experiments {
namespace {

using Causes = std::vector<Cause>;

std::string seconds_words(double time_s) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f s", time_s);
  return text;
}

std::string percent_words(double share) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
  return text;
}

std::string upper_first(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

/// "a", "a and b", "a, b and c"
std::string list_words(const Causes& causes, std::string (*words)(Cause)) {
  std::string text;
  for (std::size_t i = 0; i < causes.size(); ++i) {
    if (i > 0) text += i + 1 == causes.size() ? " and " : ", ";
    text += words(causes[i]);
  }
  return text;
}

void add_found(const Explanation& explanation, std::vector<std::string>& sentences) {
  for (const Cause cause : explanation.necessary) {
    const std::string with = holds(explanation.sufficient, cause)
                                 ? " With everything else taken away it still fails, so that this "
                                   "cause is sufficient."
                                 : "";
    sentences.push_back("Cause: " + words_for(cause) + ". " + upper_first(words_without(cause)) +
                        " the estimator survives, so that this cause is necessary." + with);
  }
  if (!explanation.together.empty()) {
    sentences.push_back("None of them is sufficient by itself: the failure takes " +
                        list_words(explanation.together, words_for) + " together.");
  }
  if (!explanation.not_changed.empty()) {
    sentences.push_back("Whether a cause is sufficient was not tried, because " +
                        list_words(explanation.not_changed, words_for) +
                        " had to stay as in the flight.");
  }
  if (!explanation.necessary.empty()) return;
  if (!explanation.sufficient.empty()) {
    const bool several = explanation.sufficient.size() > 1;
    sentences.push_back("Cause: " + list_words(explanation.sufficient, words_for) + ". " +
                        (several ? "Each of them is" : "It is") +
                        " sufficient: with everything else taken away the estimator still fails.");
  }
  if (!explanation.pair.empty()) {
    sentences.push_back("It survives " + list_words(explanation.pair, words_without) +
                        "; taking away one of them is not enough.");
  }
  if (explanation.sufficient.empty() && explanation.pair.empty()) {
    sentences.emplace_back(
        "No single cause that was tried explains the failure: the estimator fails without each of "
        "them.");
  }
}

std::string other_seed_words(const Explanation& explanation) {
  if (!*explanation.reproduced_with_other_seed) {
    return "With other random numbers the estimator survives: chance decides this flight, and the "
           "causes above are uncertain.";
  }
  Causes unconfirmed = explanation.necessary;
  std::erase_if(unconfirmed, [&](Cause cause) { return holds(explanation.confirmed, cause); });
  const std::string rest =
      unconfirmed.empty()
          ? ""
          : " Not tried with other random numbers: " + list_words(unconfirmed, words_for) + ".";
  if (explanation.withdrawn.empty()) {
    if (unconfirmed.empty()) return "With other random numbers the result is the same.";
    const std::string survives =
        explanation.confirmed.empty()
            ? ""
            : ", and survives " + list_words(explanation.confirmed, words_without);
    return "With other random numbers it fails again" + survives + "." + rest;
  }
  return "It survived " + list_words(explanation.withdrawn, words_without) +
         " by chance: with other random numbers it fails nevertheless, so that " +
         (explanation.withdrawn.size() > 1 ? "these are" : "this is") + " not named as a cause." +
         rest;
}

void add_limits(const Explanation& explanation, std::vector<std::string>& sentences) {
  if (explanation.margin) {
    const CauseMargin& margin = *explanation.margin;
    sentences.push_back("Margin: it survives " + percent_words(margin.survives_share) + " of " +
                        words_for(margin.cause) + " and fails at " +
                        percent_words(margin.fails_share) + ".");
  }
  if (explanation.reproduced_with_other_seed) {
    sentences.push_back(other_seed_words(explanation));
  }
  if (explanation.data_limited) {
    sentences.push_back("The data, not the estimator, is the limit. " + explanation.data_reason);
  }
}

}  // namespace

std::string outcome_words(const evaluation::Score& score) {
  std::string text = evaluation::to_string(score.outcome);
  if (score.outcome_time_s) text += " at " + seconds_words(*score.outcome_time_s);
  return text;
}

std::string margin_words(const CauseMargin& margin) {
  return "survives " + percent_words(margin.survives_share) + " of it and fails at " +
         percent_words(margin.fails_share);
}

std::string result_words(const Reflight& flight) {
  if (!flight.error.empty()) return "no result: " + flight.error;
  return (flight.survived ? "survives: " : "fails: ") + outcome_words(flight.score);
}

std::vector<std::string> sentences_of(const Explanation& explanation) {
  const std::string& name = explanation.estimator;
  if (explanation.succeeded) {
    return {name + " completed this flight: there is nothing to explain."};
  }
  std::vector<std::string> sentences = {name + ": " + outcome_words(explanation.score) + "."};
  if (!explanation.reproduced && explanation.parts_left_out) {
    sentences.emplace_back(
        "Its failure was not seen again in the parts of the flight that were flown. The limit of "
        "flights left out the longer parts: allow more flights.");
    return sentences;
  }
  if (!explanation.reproduced) {
    sentences.emplace_back(
        "Flown again with nothing changed, its failure does not come again. It cannot be explained "
        "by changing one cause at a time: it depends on chance, or on the load of the machine if "
        "the run was flown in real time.");
    return sentences;
  }
  sentences.push_back("It fails again when only the flight from " +
                      seconds_words(explanation.part.from_s) + " to " +
                      seconds_words(explanation.part.to_s) + " is flown.");
  add_found(explanation, sentences);
  add_limits(explanation, sentences);
  return sentences;
}

}  // namespace overfly::server::experiments
