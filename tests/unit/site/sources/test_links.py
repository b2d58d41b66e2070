"""Every link of the documentation leads somewhere, headings too, and every page can be reached."""

import re

from tests.kit.files import ROOT

PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def text_of(page):
    """Return the page without its code, in which brackets mean something else."""
    return re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(), flags=re.DOTALL)


def links_of(page):
    return [link for link in LINK.findall(text_of(page)) if not link.startswith(("http://", "https://", "mailto:"))]


def anchors_of(page):
    """Return the names that headings have on the usual hosts."""
    headings = re.findall(r"^#+ +(.+?)\s*$", re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_every_link_leads_somewhere():
    broken = []
    for page in PAGES:
        for link in links_of(page):
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            if not target.exists() or (anchor and anchor not in anchors_of(target)):
                broken.append(f"{page.relative_to(ROOT)}: {link}")
    assert broken == []


def test_every_page_can_be_reached_from_the_readme():
    found, left = set(), [ROOT / "README.md"]
    while left:
        page = left.pop()
        found.add(page)
        for link in links_of(page):
            target = (page.parent / link.partition("#")[0]).resolve()
            target = next(iter(sorted(target.glob("README.md"))), target) if target.is_dir() else target
            pages = sorted(target.glob("*.md")) if target.is_dir() else [target]
            left += [each for each in pages if each.suffix == ".md" and each.exists() and each not in found]
    assert [str(page.relative_to(ROOT)) for page in PAGES if page not in found] == []
