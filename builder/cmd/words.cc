// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/command_line.h"
#include "builder/recipe/keys.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>

namespace ds {
namespace {

[[noreturn]] void refuse_verb(const std::string& word) {
  std::error_code error;
  if (std::filesystem::exists(word, error))
    fail(ErrorKind::usage, "{} is no verb; to make its images: dsbuild build {}", word, word);
  fail(ErrorKind::usage, "{} is no verb of dsbuild{}", word, known_words(word, verb_names()));
}

/// "; plan has it", "".
std::string verbs_with(const CLI::App& app, const std::string& name) {
  std::vector<std::string> having;
  for (const Verb& verb : verbs())
    if (app.get_subcommand(verb.name)->get_option_no_throw(name) != nullptr)
      having.emplace_back(verb.name);
  if (having.empty()) return "";
  return fmt::format("; {} {} it", fmt::join(having, ", "), having.size() == 1 ? "has" : "have");
}

/// "engine.spp" of --spp, where the verb takes a recipe's keys and that is one's own name.
std::string_view key_of_option(const CLI::App* verb, std::string name) {
  if (verb == nullptr || verb->get_option_no_throw("--set") == nullptr) return "";
  name.erase(0, name.find_first_not_of('-'));
  std::replace(name.begin(), name.end(), '-', '_');
  for (const KeySpec& key : recipe_keys()) {
    const std::string_view own = key.name.substr(key.name.rfind('.') + 1);
    const bool less_unit =
        name.size() >= 3 && own.starts_with(name) && own.substr(name.size()).starts_with('_');
    if (own == name || less_unit) return key.name;
  }
  return "";
}

[[noreturn]] void refuse_option(const CLI::App& app, const CLI::App* verb,
                                const std::string& name) {
  const std::string elsewhere = verbs_with(app, name);
  if (verb == nullptr && !elsewhere.empty())
    fail(ErrorKind::usage, "{} stands before the verb: write dsbuild VERB {}", name, name);
  const std::string owner = verb == nullptr ? "dsbuild" : verb->get_name();
  if (const std::string_view key = key_of_option(verb, name); !key.empty())
    fail(ErrorKind::usage, "{} has no option {}: it is the recipe's {}; write --set {}=VALUE",
         owner, name, key, key);
  if (!elsewhere.empty()) fail(ErrorKind::usage, "{} has no option {}{}", owner, name, elsewhere);
  std::vector<std::string> known;
  for (const CLI::App* one : {verb, &app})
    for (const CLI::Option* option :
         one == nullptr ? std::vector<const CLI::Option*>{} : one->get_options())
      for (const bool is_long : {false, true})
        for (const std::string& word : is_long ? option->get_lnames() : option->get_snames())
          known.push_back((is_long ? "--" : "-") + word);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  const std::vector<std::string_view> words(known.begin(), known.end());
  fail(ErrorKind::usage, "{} has no option {}{}", owner, name, known_words(name, words));
}

/// The option of that name, of the verb or of the whole command. Throws where there is none.
const CLI::Option& find_option(const CLI::App& app, const CLI::App* verb, const std::string& name) {
  const CLI::Option* option = verb == nullptr ? nullptr : verb->get_option_no_throw(name);
  if (option == nullptr) option = app.get_option_no_throw(name);
  if (option == nullptr) refuse_option(app, verb, name);
  return *option;
}

/// "--set KEY=VALUE"
std::string with_value(const std::string& name, const CLI::Option& option) {
  return fmt::format("{} {}", name, option.get_type_name());
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_min() > 0;
}

bool looks_like_option(std::string_view word) {
  return word.size() > 1 && word[0] == '-' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

/// Walks over the words as CLI11 will.
class Walk {
 public:
  Walk(const CLI::App& app, std::span<const char* const> words) : app_(app), words_(words) {}

  void run() {
    bool only_positionals = false;
    for (at_ = 1; at_ < words_.size(); ++at_) {
      const std::string word = words_[at_];
      if (only_positionals)
        positionals_.push_back(word);
      else if (word == "--")
        only_positionals = true;
      else
        take(word);
    }
    check_positionals();
  }

 private:
  void take(const std::string& word) {
    if (word.starts_with("--"))
      long_option(word);
    else if (looks_like_option(word))
      short_options(word);
    else if (verb_ == nullptr)
      take_verb(word);
    else
      positionals_.push_back(word);
  }

  void take_verb(const std::string& word) {
    const std::vector<std::string_view> names = verb_names();
    if (std::find(names.begin(), names.end(), word) == names.end()) refuse_verb(word);
    verb_ = app_.get_subcommand(word);
  }

  std::string owner() const { return verb_ == nullptr ? "dsbuild" : verb_->get_name(); }

  void long_option(const std::string& word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const CLI::Option& option = find_option(app_, verb_, name);
    if (equals == word.npos)
      meet(name, option, std::nullopt);
    else if (takes_value(option))
      meet(name, option, word.substr(equals + 1));
    else
      fail(ErrorKind::usage, "{} {}: takes no value, got {}", owner(), name,
           word.substr(equals + 1));
  }

  /// "-n", "-kn", "-oFOLDER"
  void short_options(const std::string& word) {
    for (std::size_t i = 1; i < word.size(); ++i) {
      const std::string name{'-', word[i]};
      const CLI::Option& option = find_option(app_, verb_, name);
      const bool last = i + 1 == word.size();
      const bool has_rest = takes_value(option) && !last;
      meet(name, option, has_rest ? std::optional(word.substr(i + 1)) : std::nullopt);
      if (takes_value(option)) return;
    }
  }

  /// Takes the next word where the option's value is still to come.
  void meet(const std::string& name, const CLI::Option& option, std::optional<std::string> value) {
    if (!takes_value(option)) return;
    const bool repeatable = option.get_items_expected_max() > 1;
    if (!met_.insert(&option).second && !repeatable)
      fail(ErrorKind::usage, "{} {}: wanted once, found again", owner(), name);
    if (!value) {
      if (++at_ == words_.size())
        fail(ErrorKind::usage, "{}: wanted {}, found nothing behind it", owner(),
             with_value(name, option));
      value = words_[at_];
      if (looks_like_option(*value))
        fail(ErrorKind::usage, "{}: wanted {}, found {} behind it", owner(),
             with_value(name, option), *value);
    }
    // An empty variable of a shell, most likely, and not what is done without the option.
    if (value->empty())
      fail(ErrorKind::usage, "{}: wanted {}, found nothing in its quotes", owner(),
           with_value(name, option));
    if (name == "--set") check_assignment(*value);
  }

  /// A missing "=" leaves the value to be taken for a word too many.
  void check_assignment(const std::string& text) const {
    if (text.find('=') != text.npos) return;
    const bool value_follows = at_ + 1 < words_.size() && !looks_like_option(words_[at_ + 1]) &&
                               text.find('.') != text.npos;
    fail(ErrorKind::usage, "{} --set: wanted KEY=VALUE, found {}{}", owner(), text,
         value_follows ? fmt::format(" {0}; write --set {1}={0}", words_[at_ + 1], text)
                       : "; write it as --set engine.width=64");
  }

  void check_positionals() const {
    if (verb_ == nullptr) return;
    std::vector<std::string> known;
    for (const CLI::Option* option : verb_->get_options())
      if (option->get_positional()) known.push_back(option->get_name());
    for (const CLI::Option* option : verb_->get_options())
      if (option->get_positional() && option->get_items_expected_max() > 1) return;
    for (std::size_t i = 0; i < std::min(positionals_.size(), known.size()); ++i)
      if (positionals_[i].empty())
        fail(ErrorKind::usage, "{}: wanted {}, found nothing in its quotes", owner(), known[i]);
    if (positionals_.size() <= known.size()) return;
    const auto first_extra = positionals_.begin() + static_cast<std::ptrdiff_t>(known.size());
    fail(ErrorKind::usage, "{}: does not know what to do with {}; it takes {}; see dsbuild help {}",
         owner(), fmt::format("{}", fmt::join(first_extra, positionals_.end(), " ")),
         known.empty() ? "options only" : fmt::format("{}", fmt::join(known, " and ")), owner());
  }

  const CLI::App& app_;
  std::span<const char* const> words_;
  std::size_t at_ = 0;
  const CLI::App* verb_ = nullptr;
  std::set<const CLI::Option*> met_;
  std::vector<std::string> positionals_;
};

}  // namespace

std::vector<std::string_view> verb_names() {
  std::vector<std::string_view> names;
  for (const Verb& verb : verbs())
    names.emplace_back(verb.name);
  return names;
}

void check_words(const CLI::App& app, std::span<const char* const> words) {
  Walk(app, words).run();
}

}  // namespace ds
