// The manual page and the completion of the command, written from the commands and options that it has.
#include "app/commands.hpp"
#include "output/machine.hpp"

#include <algorithm>

namespace weir::app {

namespace {

/// As roff takes it literally.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if (c == '\n')
            out += ' ';
        else
            out += c;
    }
    return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool positional) {
    std::vector<const CLI::Option*> list;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional() == positional) list.push_back(option);
    return list;
}

/// "--out, -o TEXT", as the help shows it.
std::string spelled(const CLI::Option& option) {
    std::string names;
    for (const auto& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
    for (const auto& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
    const bool takes_value = option.get_items_expected_max() > 0;
    return takes_value ? names + " " + option.get_type_name() : names;
}

std::string synopsis(const CLI::App& command) {
    std::string line = "weir " + command.get_name();
    for (const CLI::Option* option : options_of(command, true))
        line += (option->get_required() ? " " : " [") + option->get_single_name() + (option->get_required() ? "" : "]");
    return line + " [OPTION...]";
}

std::string entry(const std::string& term, const std::string& text) { return ".TP\n.B " + roff(term) + "\n" + roff(text) + "\n"; }

}  // namespace

std::string man_page(const CLI::App& app) {
    const auto machine = output::this_machine();
    std::string page =
        ".TH WEIR 1 \"\" \"weir " + machine.version +
        "\" \"User Commands\"\n.SH NAME\nweir \\- fluid simulation by real\\-time methods, with verified accuracy and measured cost\n";
    page += ".SH SYNOPSIS\n.B weir\n.I COMMAND\n.RI [ OPTION ...]\n.SH DESCRIPTION\n" +
            roff(
                "Simulates fluids by the methods of real-time graphics, from scenes in TOML files; verifies and validates their results "
                "against references; and measures the cost of accuracy. A scene is given as a file, as a folder, or, where no such file "
                "exists, as the name of a case.") +
            "\n.SH COMMANDS\n";
    for (const CLI::App* command : app.get_subcommands({})) {
        page += ".SS " + roff(synopsis(*command)) + "\n" + roff(command->get_description()) + "\n";
        for (const bool positional : {true, false})
            for (const CLI::Option* option : options_of(*command, positional))
                if (option != command->get_help_ptr())
                    page += entry(positional ? option->get_single_name() : spelled(*option), option->get_description());
    }
    page += ".SH EXIT STATUS\n" + entry("0", "Success.") + entry("1", "A claim failed, or no configuration meets the request.") +
            entry("2", "Invalid input, or output that cannot be written; nothing was run.") +
            entry("3", "Numerical failure of a run; its last good state is saved.") +
            entry("130, 143", "Interrupted or terminated; the files written so far stay readable.");
    page += ".SH ENVIRONMENT\n" + entry("OMP_NUM_THREADS", "Maximum number of threads; results do not depend on it.");
    return page + ".SH FILES\n" + entry("/usr/share/weir/cases", "The cases: scenes, claims and reference data.") +
           entry("/usr/share/weir/results/cost", "The published tables from which weir plan chooses.");
}

std::string bash_completion(const CLI::App& app) {
    std::string commands, cases;
    for (const CLI::App* command : app.get_subcommands({})) {
        std::string options;
        for (const CLI::Option* option : options_of(*command, false))
            for (const auto& name : option->get_lnames()) options += " --" + name;
        commands += " " + command->get_name();
        cases += "        " + command->get_name() + ") options=\"" + options.substr(std::min<std::size_t>(1, options.size())) + "\" ;;\n";
    }
    std::string words;
    for (const auto& word : listed) words += " " + word;
    return "# completion of weir for bash\n_weir() {\n    local word words options command=\"\" current=\"${COMP_WORDS[COMP_CWORD]}\"\n"
           "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n        [[ $word == -* ]] || { command=$word; break; }\n    done\n"
           "    case \"$command\" in\n        \"\") options=\"" +
           commands.substr(1) + " --help --version\" ;;\n" + cases +
           "    esac\n    if [[ -z $command || $current == -* ]]; then\n        COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n   "
           "     return\n    fi\n"
           "    case \"$command\" in\n        run | validate | cost | plan | stability | live) words=\"$(weir list cases 2>/dev/null | tr "
           "-d '*')\" ;;\n"
           "        describe) words=\"$(weir list solvers 2>/dev/null | cut -d' ' -f1) $(weir list effects 2>/dev/null | sed -n 's/^  "
           "\\([^ ]*\\).*/\\1/p')\" ;;\n"
           "        list) words=\"" +
           words.substr(1) +
           "\" ;;\n    esac\n"
           "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\") $(compgen -f -- \"$current\"))\n}\ncomplete -o filenames -F _weir "
           "weir\n";
}

}  // namespace weir::app
