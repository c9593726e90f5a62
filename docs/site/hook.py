"""Hook of mkdocs: writes the search index as a script, because a page opened from disk may load scripts but no JSON."""
import pathlib


def on_post_build(config):
    search = pathlib.Path(config["site_dir"]) / "search"
    (search / "index.js").write_text("weir_pages(" + (search / "search_index.json").read_text() + ");\n")
    for name in ("lunr.js", "main.js", "worker.js", "search_index.json", "../sitemap.xml", "../sitemap.xml.gz"):
        (search / name).unlink(missing_ok=True)
