"""Pages and results: what scripts/render-docs writes, and that it finds each fault."""
import csv
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import published_rows  # noqa: E402

RENDER = ROOT / "scripts" / "render-docs"
COUNT = ROOT / "scripts" / "count-docs"
HEADER = "study,tree,date,seed,pairs,command,scenario,condition,measure,unit,mean,low,high,lost_evs,origin,behaviour"


def run(*words):
    return subprocess.run([sys.executable, *map(str, words)], capture_output=True, text=True, check=False)


BEHAVIOUR = run(RENDER, "--behaviour").stdout.strip()


def row(condition="corridor", measure="time_s:difference", unit="s", mean="-25.2", low="-29.0", high="-21.5", scenario="city",
        origin="product", behaviour=BEHAVIOUR, lost="0 of 210", study="signals", pairs="30", tree="5a206d0", date="2026-11-24"):
    return (f'{study},{tree},{date},7461,{pairs},clearway study studies/signals.toml,{scenario},"{condition}",{measure},{unit},'
            f"{mean},{low},{high},{lost},{origin},{behaviour}")


TABLE = """<!-- table: signals
rows: condition
columns: measure
titles: time_s:difference = EV travel time, s; condition = policy
-->
<!-- end of table -->
"""


class Tree(unittest.TestCase):
    """A tree of one page and one file of results."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        for name in ("docs", "results", "tests/loop"):
            (self.root / name).mkdir(parents=True)
        shutil.copy(ROOT / "tests/loop/golden.txt", self.root / "tests/loop")

    def rows(self, *rows, header=HEADER):
        (self.root / "results/signals.csv").write_text("\n".join((header, *rows)) + "\n", encoding="utf-8")

    def page(self, text):
        (self.root / "docs/a.md").write_text(text, encoding="utf-8")

    def rendered(self, text):
        """The page after a run without faults."""
        self.page(text)
        done = run(RENDER, "--root", self.root)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(run(RENDER, "--root", self.root, "--check").returncode, 0)
        return (self.root / "docs/a.md").read_text(encoding="utf-8")

    def refused(self, place, words, text="text\n"):
        """The check fails with a line of this place and these words; so does writing, which leaves the page as it is."""
        self.page(text)
        for options in (["--check"], []):
            done = run(RENDER, "--root", self.root, *options)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertRegex(done.stderr, re.escape(place) + r": .*" + re.escape(words))
        self.assertEqual((self.root / "docs/a.md").read_text(encoding="utf-8"), text)


class Rendered(Tree):
    def test_a_table_has_titles_signs_intervals_and_its_source(self):
        self.rows(row(), row("slow", mean="3.0", low="-1.0", high="7.0"), row("none", mean="-0.0", low="", high=""))
        text = self.rendered(TABLE)
        self.assertIn("| policy | EV travel time, s |\n|---|---|\n| corridor | -25.2 [-29.0, -21.5] |\n"
                      "| slow | +3.0 [-1.0, 7.0] |\n| none | 0.0 |\n", text)
        self.assertIn("Source: `clearway study studies/signals.toml`, 30 pairs, seed 7461, tree 5a206d0, 2026-11-24.", text)
        self.assertNotIn("\N{DAGGER}", text)

    def test_where_selects_and_orders_values_that_may_hold_commas(self):
        self.rows(row("a"), row("memory 4 s, loss 50 %"), row("b"))
        text = self.rendered(TABLE.replace("titles", "where: condition = b, memory 4 s, loss 50 %\ntitles"))
        self.assertRegex(text, r"(?s)\| b \|.*\| memory 4 s, loss 50 % \|")
        self.assertNotIn("| a |", text)

    def test_pairs_of_names_select_cells(self):
        self.rows(row("a"), row("b"), row("a", scenario="merge"), row("b", scenario="merge"))
        text = self.rendered(TABLE.replace("rows: condition", "rows: scenario, condition").replace(
            "titles", "where: scenario / condition = merge / b,\n  city / a\ntitles"))
        self.assertRegex(text, r"(?s)\| merge \| b \|.*\| city \| a \|")
        self.assertNotIn("| city | b |", text)

    def test_lost_vehicles_pairs_and_means_alone_on_demand(self):
        self.rows(row(lost="1 of 210"))
        text = self.rendered(TABLE.replace("titles", "lost: yes\npairs: yes\nshow: mean\nsource: no\ntitles"))
        self.assertIn("| policy | EV travel time, s | lost EVs | pairs |", text)
        self.assertIn("| corridor | -25.2 | 1 of 210 | 30 |", text)
        self.assertNotIn("Source", text)

    def test_a_figure_has_sign_unit_and_interval(self):
        self.rows(row(mean="2.0", low="1.0", high="3.0"), row(measure="time_s", mean="165.0", low="", high=""),
                  row(measure="time_s:percent", unit="%"))
        text = self.rendered("It is <!--= signals | city | corridor | time_s:difference -->?<!--/-->, "
                             "<!--= signals | city |\ncorridor | time_s --><!--/-->, "
                             "<!--= signals | city | corridor | time_s:percent | mean -->x<!--/-->\n")
        self.assertEqual(re.findall(r"-->([^<]+)<!--/", text), ["+2.0 s [1.0, 3.0]", "165.0 s", "-25.2 %"])

    def test_a_figure_may_be_broken_across_lines(self):
        self.rows(row())
        broken = "It is <!--= signals | city | corridor | time_s:difference -->-25.2 s\n[-29.0, -21.5]<!--/-->\n"
        self.assertEqual(self.rendered(broken), broken)

    def test_rows_of_other_behaviour_and_transcribed_ones_have_a_dagger_and_a_note(self):
        self.rows(row("new"), row("old", behaviour="0" * 12, tree="1111111"), row("taken", origin="transcribed", behaviour="", tree="2222222"))
        text = self.rendered(TABLE)
        self.assertIn("| new | -25.2", text)
        self.assertIn("| old \N{DAGGER} | -25.2", text)
        self.assertIn("| taken \N{DAGGER} | -25.2", text)
        self.assertIn("\N{DAGGER} Measured earlier and not repeated with this version: tree 2222222, 2026-11-24.\\\n"
                      "\N{DAGGER} Clearway's behaviour has changed since: tree 1111111, 2026-11-24.\n", text)

    def test_rows_of_before_holds_by_queues_stand_while_the_runs_by_the_lead_do(self):
        earlier = published_rows.behaviours(ROOT)[1]
        self.assertNotEqual(earlier, BEHAVIOUR)
        self.rows(row(behaviour=earlier))
        self.assertNotIn("\N{DAGGER}", self.rendered(TABLE))

    def test_a_change_of_a_golden_run_makes_rows_old(self):
        golden = self.root / "tests/loop/golden.txt"
        runs = golden.read_text(encoding="utf-8")
        changed = re.sub("^(vacate_lane )(.)", lambda found: found[1] + ("0" if found[2] != "0" else "1"), runs, flags=re.MULTILINE)
        for behaviour in published_rows.behaviours(ROOT):
            self.rows(row(behaviour=behaviour))
            golden.write_text(runs, encoding="utf-8")
            self.rendered(TABLE)
            golden.write_text(changed, encoding="utf-8")
            done = run(RENDER, "--root", self.root, "--check")
            self.assertEqual(done.returncode, 1)
            self.assertIn("| corridor \N{DAGGER} |", done.stderr)

    def test_a_picture_is_drawn_from_its_rows(self):
        self.rows(row("a"), row("b", low="", high=""), row("c", measure="b_s", mean="1.0", low="0.0", high="2.0"))
        (self.root / "docs/images").mkdir()
        spec = "<!-- picture: signals\nimage: gain\nalt: What it gains\nrows: condition\ncolumns: measure\n-->\n<!-- end of picture -->\n"
        text = self.rendered(spec)
        self.assertIn("\n![What it gains](images/gain.svg)\n", text)
        image = self.root / "docs/images/gain.svg"
        drawn = image.read_text(encoding="utf-8")
        self.assertEqual(drawn.count("<circle"), 3)
        self.assertEqual([label for label in "abc" if f">{label}</text>" in drawn], ["a", "b", "c"])
        xml.dom.minidom.parseString(drawn)
        image.write_text(drawn.replace("<circle", "<square"), encoding="utf-8")
        done = run(RENDER, "--root", self.root, "--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn("docs/a.md:1: docs/images/gain.svg is not what the rows say: run scripts/render-docs", done.stderr)
        both = self.rendered(spec.replace("picture", "table"))
        self.assertRegex(both, r"(?s)!\[What it gains\]\(images/gain.svg\)\n\n\| condition \|")
        self.refused("docs/a.md:1", "a description in 'alt'", spec.replace("alt: What it gains\n", ""))

    def test_markers_in_code_are_text(self):
        self.rows(row())
        example = "```\n<!-- table: gone\n<!--= gone -->\n```\n"
        self.assertEqual(self.rendered(example), example)


class Faults(Tree):
    def setUp(self):
        super().setUp()
        self.rows(row())

    def figure(self, spec):
        return f"\n\nIt is <!--= {spec} -->-25.2 s<!--/-->\n"

    def test_unknown_file(self):
        self.refused("docs/a.md:3", "no file results/gone.csv", self.figure("gone | city | corridor | time_s:difference"))
        self.refused("docs/a.md:1", "no file results/gone.csv", TABLE.replace("signals", "gone"))

    def test_unknown_row(self):
        self.refused("docs/a.md:3", "has no row city | gone | time_s:difference; its conditions are corridor",
                     self.figure("signals | city | gone | time_s:difference"))
        self.refused("docs/a.md:1", "no row with condition 'gone'", TABLE.replace("titles", "where: condition = gone\ntitles"))

    def test_a_value_that_other_values_exclude(self):
        self.rows(row(), row("b", scenario="merge"))
        self.refused("docs/a.md:1", "no row has condition 'b'",
                     TABLE.replace("titles", "where: condition = corridor, b; scenario = city\ntitles"))

    def test_two_rows_with_one_key(self):
        self.rows(row(), row())
        self.refused("results/signals.csv:3", "as in line 2")

    def test_two_rows_for_one_cell(self):
        self.rows(row(), row(scenario="merge"))
        self.refused("docs/a.md:1", "results/signals.csv:2 and results/signals.csv:3 are for one cell", TABLE)

    def test_rows_that_disagree_about_lost_vehicles(self):
        self.rows(row(), row(measure="b_s", lost="1 of 210"))
        self.refused("docs/a.md:1", "disagree about lost_evs", TABLE.replace("titles", "lost: yes\ntitles"))

    def test_bad_header(self):
        self.rows(row(), header=HEADER.replace("tree", "commit"))
        self.refused("results/signals.csv:1", "the header is")

    def test_bad_number(self):
        for values, words in ((dict(mean="fast"), "mean 'fast' is not"), (dict(low=""), "low '' and high"),
                              (dict(low="-1"), "mean -25.2 is outside"), (dict(pairs="many"), "pairs 'many'")):
            self.rows(row(**values))
            self.refused("results/signals.csv:2", words)

    def test_bad_fields(self):
        for values, words in ((dict(origin="guess"), "origin 'guess'"), (dict(behaviour=""), "behaviour ''"),
                              (dict(origin="transcribed"), "behaviour '"), (dict(scenario="a | b"), "scenario 'a | b'"),
                              (dict(tree="today"), "tree 'today'"), (dict(date="2026-13-01"), "date '2026-13-01'"), (dict(lost="one"), "lost_evs 'one'"),
                              (dict(measure="time_s:percent"), "is not %"), (dict(measure="Time"), "measure 'Time'"),
                              (dict(scenario="ci\0ty"), r"scenario 'ci\x00ty' contains an unprintable character")):
            self.rows(row(**values))
            self.refused("results/signals.csv:2", words)
        self.rows(row() + ",more")
        self.refused("results/signals.csv:2", "17 fields, not 16")

    def test_files_that_are_no_plain_text(self):
        path = self.root / "results/signals.csv"
        good = path.read_bytes()
        for data, place, words in ((good.replace(b"city", b"c\xedty"), "results/signals.csv:2", "byte 0xed is not UTF-8"),
                                   (good.replace(b"\n", b"\r\n"), "results/signals.csv:1", "a carriage return"),
                                   (b"\xef\xbb\xbf" + good, "results/signals.csv:1", r"the header is '\ufeffstudy"),
                                   (b"", "results/signals.csv:1", "the header is ''")):
            path.write_bytes(data)
            self.refused(place, words)
        path.write_bytes(good)
        for data, words in ((b"text\n\n\xfc\n", "docs/a.md:3: byte 0xfc is not UTF-8"),
                            (b"text\n\ntext\r\n", "docs/a.md:3: a carriage return")):
            (self.root / "docs/a.md").write_bytes(data)
            done = run(RENDER, "--root", self.root)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.stderr)
            self.assertEqual((self.root / "docs/a.md").read_bytes(), data)

    def test_a_figure_in_a_heading_or_in_a_table_by_hand(self):
        figure = "<!--= signals | city | corridor | time_s:difference -->1<!--/-->"
        self.refused("docs/a.md:3", "a figure in a heading", f"text\n\n## Gain {figure}\n")
        self.refused("docs/a.md:5", "a figure in a table by hand", f"text\n\n| a | b |\n|---|---|\n| a | {figure} |\n")

    def test_a_figure_at_the_start_of_a_line(self):
        figure = "<!--= signals | city | corridor | time_s:difference -->1<!--/-->"
        self.refused("docs/a.md:2", "a figure at the start of a line", f"It is\n{figure} or so\n")
        self.refused("docs/a.md:2", "a figure at the start of a line", f"- It is\n  {figure} or so\n")

    def test_a_picture_that_no_page_draws(self):
        (self.root / "docs/images").mkdir()
        (self.root / "docs/images/by_hand.svg").write_text("<svg/>", encoding="utf-8")
        self.refused("docs/images/by_hand.svg:1", "no page draws this picture")

    def test_markers_without_a_block(self):
        self.refused("docs/a.md:2", "belongs to no block", "text\n<!-- end of table -->\n")
        self.refused("docs/a.md:2", "belongs to no block", "text\n1 s<!--/-->\n")

    def test_blocks_without_an_end(self):
        self.refused("docs/a.md:2", "this table has no end", "\n" + TABLE.replace("<!-- end of table -->", ""))
        self.refused("docs/a.md:1", "this table has no end", TABLE.replace("<!-- end of table -->", "") + TABLE)
        self.refused("docs/a.md:1", "this figure has no end", "It is <!--= signals | city | corridor | time_s:difference -->1 s\n")

    def test_specs(self):
        for old, new, words in (("titles:", "title:", "unknown key 'title'"), ("titles:", "rows: measure\ntitles:", "is there twice"),
                                ("rows: condition", "rows: policy", "'policy' is none of"), ("columns: measure", "", "one or two names"),
                                ("columns: measure", "columns: condition", "share a name"),
                                ("titles:", "lost: maybe\ntitles:", "lost: 'maybe'"), ("titles:", "where: city\ntitles:", "is not NAME = VALUE"),
                                ("condition = policy", "gone = policy", "titles: 'gone = policy' names nothing"),
                                ("condition = policy", "condition = a; condition = b", "titles: 'condition' is there twice"),
                                ("titles:", "free text\ntitles:", "'free text' is not a key")):
            self.refused("docs/a.md:1", words, TABLE.replace(old, new, 1))
        self.refused("docs/a.md:3", "is not FILE | SCENARIO", self.figure("signals | city"))
        self.refused("docs/a.md:3", "is not FILE | SCENARIO", self.figure("signals | city | corridor | time_s:difference | median"))


class ThisTree(unittest.TestCase):
    """The pages of this tree, with rows that were changed in a copy."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for part in ("docs", "results"):
            shutil.copytree(ROOT / part, self.root / part)
        (self.root / "tests/loop").mkdir(parents=True)
        shutil.copy(ROOT / "tests/loop/golden.txt", self.root / "tests/loop")
        shutil.copy(ROOT / "README.md", self.root)
        self.pages = {page.relative_to(ROOT).as_posix(): page.read_text(encoding="utf-8")
                      for page in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))}

    @staticmethod
    def change(path, choose):
        """Rows that `choose` takes have another mean and no interval; returns how many these are."""
        rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
        chosen = [row for row in rows if choose(row)]
        for row in chosen:
            row |= dict(mean="123456.7", low="", high="")
        with path.open("w", encoding="utf-8", newline="") as opened:
            writer = csv.DictWriter(opened, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        return len(chosen)

    def test_a_changed_row_makes_a_page_wrong(self):
        """For each page with a figure in its text: the row of the first one is changed, and the check names its line."""
        tried = 0
        for name, text in self.pages.items():
            figure = re.search(r"<!--= ([^>]*?) -->", text)
            if figure is None:
                continue
            file, *key = (" ".join(part.split()) for part in figure[1].split("|")[:4])
            results = self.root / "results" / f"{file}.csv"
            before = results.read_bytes()
            self.assertEqual(self.change(results, lambda row: [row["scenario"], row["condition"], row["measure"]] == key), 1, figure[1])
            line = text.count("\n", 0, figure.start()) + 1
            done = run(RENDER, "--root", self.root, "--check", self.root / name)
            results.write_bytes(before)
            self.assertEqual(done.returncode, 1, name)
            self.assertRegex(done.stderr, rf"(?m)^{re.escape(name)}:{line}: the page says '.*', the rows '.*123456\.7.*': "
                             "run scripts/render-docs$")
            tried += 1
        self.assertGreater(tried, 0, "no page shows a figure")

    def test_no_block_stays_right_when_all_rows_change(self):
        for results in (self.root / "results").glob("*.csv"):
            self.change(results, lambda row: True)
        done = run(RENDER, "--root", self.root, "--check")
        wrong = {(name, int(line)) for name, line in re.findall(r"(?m)^(\S+\.md):(\d+): ", done.stderr)}
        blocks = [(name, block) for name, text in self.pages.items() for block in published_rows.find_blocks(name, text, [])]
        self.assertGreater(len(blocks), 100)
        for name, block in blocks:
            last = published_rows.line_of(self.pages[name], block.end)
            self.assertTrue(any((name, line) in wrong for line in range(block.line, last + 1)), f"{name}:{block.line}: {block.spec}")


class Counts(Tree):
    def counted(self, text, page="docs/findings/a.md"):
        (self.root / page).parent.mkdir(parents=True, exist_ok=True)
        (self.root / page).write_text(text, encoding="utf-8")
        limits = self.root / "tests/docs/limits_of_docs.txt"
        limits.parent.mkdir(exist_ok=True)
        if not limits.exists():
            limits.write_text("words 100\ntable_words 100\nnumbers 100\nlong_lines 100\ndrawings 0\n", encoding="utf-8")
        done = run(COUNT, "--root", self.root)
        self.assertEqual(done.returncode, 0, done.stderr)
        return {name: int(count) for count, name in re.findall(r"(?m)^ *(\d+) (\w+), of", done.stdout)}

    def test_words_are_those_of_prose(self):
        text = ("# Two words\n\n`one` <!-- none at all --> three\n\n    no code\n\n```\nno code\n```\n- item\n\n    its paragraph\n\n"
                "| a | b c |\n|---|---|\n\n" + TABLE.replace("-->\n<!-- end", "-->\n| generated |\n<!-- end"))
        counts = self.counted(text)
        self.assertEqual(counts["words"], 9, "#, Two, words, one, three, -, item, its, paragraph")
        self.assertEqual(counts["table_words"], 3, "a, b, c")

    def test_numbers_that_look_measured(self):
        text = ("It gains 4.3 s (95 % interval, x / 1 s), 4.3 s [2.9, 5.7], 3 % and 5 to 6 s at 50 km/h in 2026, `7 s`.\n\n| a | 1.0 [0.5, 1.5] | 12 |\n|---|---|---|\n\n"
                "| year | 2026 |\n|---|---|\n")
        self.assertEqual(self.counted(text)["numbers"], 6)
        (self.root / "docs/findings/a.md").unlink()
        self.assertEqual(self.counted("It gains 4.3 s [2.9, 5.7] in steps of 0.25 s.\n", "docs/guides/a.md")["numbers"], 1)
        (self.root / "docs/guides/a.md").unlink()
        self.assertEqual(self.counted("<!--= signals | a | b | c -->4.3 s [2.9, 5.7]<!--/-->\n")["numbers"], 0)

    def test_long_lines(self):
        long = "word " * 25
        text = f"{long}\n\n| {long} |\n|---|\n\n{long} https://example.org\n\n    {long}\n\nshort <!-- {long} -->\n"
        self.assertEqual(self.counted(text)["long_lines"], 1)

    def test_the_check_fails_above_a_limit(self):
        self.counted("word " * 100)
        self.assertEqual(run(COUNT, "--root", self.root, "--check").returncode, 0)
        self.counted("word " * 101)
        done = run(COUNT, "--root", self.root, "--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn("101 words are more than 100", done.stderr)
        self.assertRegex(done.stderr, r"(?m)^ +101 docs/findings/a.md$")

    def test_a_row_more_is_allowed_by_the_line_that_is_printed(self):
        table = "| name | what |\n|---|---|\n" + "| one | word |\n" * 49
        self.counted(f"# A\n\n{table}\nText.\n\n| b |\n|---|\n")
        done = run(COUNT, "--root", self.root, "--check")
        self.assertIn("101 table_words are more than 100", done.stderr)
        self.assertRegex(done.stderr, r"(?m)^ +100 docs/findings/a.md:3$")
        limits = self.root / "tests/docs/limits_of_docs.txt"
        line = re.search(r"(?m)^    (table_words \+1 .*)$", done.stderr)[1]
        limits.write_text(limits.read_text() + line.replace("REASON", "a row for b") + "\n")
        done = run(COUNT, "--root", self.root, "--check")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("101 table_words, of at most 101", done.stdout)

    def test_limits_that_a_reason_does_not_raise(self):
        self.counted("text\n")
        limits = self.root / "tests/docs/limits_of_docs.txt"
        limits.write_text(limits.read_text() + "numbers +1 2026-11-27: it looks better\n")
        self.assertIn("numbers cannot be raised", run(COUNT, "--root", self.root, "--check").stderr)

    def test_a_reader_that_stops_ends_the_list(self):
        self.counted("text\n")
        for number in range(3000):  # more than a pipe holds
            (self.root / f"docs/{number}.md").write_text("text\n", encoding="utf-8")
        counting = subprocess.Popen([sys.executable, COUNT, "--root", self.root], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        counting.stdout.readline()
        counting.stdout.close()
        self.assertEqual(counting.stderr.read(), "")
        counting.stderr.close()
        counting.wait()


if __name__ == "__main__":
    unittest.main()
