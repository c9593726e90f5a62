// weir report: the page of all published results, put together again without running anything.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "validation/page/page.hpp"
#include "validation/page/readme.hpp"
#include "validation/report/publish.hpp"
#include "validation/report/study_plots.hpp"

#include <cstdio>
#include <memory>
#include <string>

namespace weir::app {

void add_report(CLI::App& app, int& exit_code) {
    auto results = std::make_shared<std::string>("results"), readme = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("report", "Write index.md and index.html from the published results; nothing is run");
    command->add_option("results", *results, "Folder of published results (default: results)");
    command->add_option("--readme", *readme, "Also write the results between the markers of this file");
    auto plots = std::make_shared<bool>(false);
    command->add_flag("--plots", *plots, "Also draw the plots of cost and stability again, from the published values");
    command->callback([results, readme, plots, &exit_code] {
        if (*plots) validation::draw_published_studies(*results);
        validation::write_index(*results);
        std::printf("%s\n", validation::write_page(*results).c_str());
        if (!readme->empty()) validation::update_readme(*readme, *results);
        exit_code = exit_success;
    });
}

}  // namespace weir::app
