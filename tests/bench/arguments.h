#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sss::bench {

/// A command line of the form SUBJECT [SCENE] --name value ...: the bench is driven by run.py, so
/// that this is all it needs. Throws Error{Usage} for anything else, and for a name that no
/// measurement has asked for by the time of check().
class Arguments {
public:
    Arguments(int argc, const char* const* argv);

    const std::string& subject() const { return subject_; }
    const std::string& scene() const { return scene_; }
    double number(std::string_view name, double otherwise) const;
    std::vector<double> numbers(std::string_view name, const std::vector<double>& otherwise) const;
    /// Throws Error{Usage} if it was not given.
    std::string text(std::string_view name) const;
    void check() const;

private:
    const std::string* find(std::string_view name) const;

    std::string subject_, scene_;
    struct Option {
        std::string value;
        mutable bool asked = false;
    };
    std::map<std::string, Option, std::less<>> options_;
};

}  // namespace sss::bench
