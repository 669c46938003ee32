#!/usr/bin/env python3
"""Checks that every citation leads somewhere: documents, their sections and steps, rows of deviations.md, paths and names
of files and functions in comments, in the effects of the .def tables and in documents; links and section numbers in
documents. What is a citation is written in docs/conventions.md section 6.

usage: citations.py SOURCE_FOLDER
Exit status 1 and one line per fault.
"""
import fnmatch
import io
import pathlib
import re
import sys
import tokenize

ROOMS = ("base", "texel", "spirv", "raster", "glass", "icd", "manifest", "cts-subset", "tests", "docs")
ROOT_FILES = ("CMakeLists.txt", "README.md", "CONTRIBUTING.md", "run", "check", ".ci/run", ".clang-tidy")
C_FILES = (".h", ".cpp", ".def", ".frag", ".vert")
SKIPPED = (".png", ".json", ".pyc")
DEVIATIONS = "cts-subset/deviations.md"
# Files of others and of the build that comments name: without a path, and in these folders.
EXTERNAL = re.compile(r"(vk_icd|vulkan_core|enums|structure_types|entry_points|limit_rules|properties)\.h|(nir|vtn|lp|lvp|draw)_\w+\.(h|py)")
EXTERNAL_FOLDERS = ("hwy/", "vulkan/", "spirv/unified1/", "generated/", "build/")
# Documents that name others' files: only paths that begin with a room are checked there.
TELLS_OF_OTHERS = re.compile(r"docs/(lavapipe-[\w-]+|requirements)\.md")
PLANNED = {"docs/glass.md": ("glass/", "VITRINE_TOOLS", "VITRINE_REPORT")}  # what is not there yet
# Sections about other projects or about citations as such; "" is what comes before the first.
NOT_READ = {"docs/conventions.md": ("", "2", "3", "6")}

ITEM = r"(?:[A-G]\d{1,2}|[A-G]|\d{1,2}(?:\.\d{1,2})?)(?![\w]|\.\d|-[a-z])(?: (?:step|form) \w+)?"
LIST = rf"{ITEM}(?:(?:, and |, | and | to |-){ITEM})*"
DOCUMENT = re.compile(rf"(?<![\w/.-])((?:[\w.-]+/)*[A-Za-z][\w-]*\.md)\b(?:`?,? ?\(?(?:sections? |parts? |§|(?<= ))({LIST}))?")
ROW = r"[a-z0-9]+(?:-[a-z0-9]+)+"
ROWS = re.compile(rf"deviations\.md`?[:,] ({ROW}(?:(?:, and |, | and ){ROW})*)")
CASE = re.compile(r"`[a-z_]+\.(deviation\.[a-z0-9_]+)[a-z0-9_.*]*`")
SHORT = re.compile(rf"(?<![\w\])])\((?:sections? |(?=[A-G]\d|[1-9]\d?\.\d))({LIST})(?=[):,;])")
WITHIN = re.compile(rf"(?<!\.md )(?<!\.md` )\b[Ss]ections? ({LIST})(?! of (?!this))")
EFFECT = re.compile(rf"(?:section |(?=[A-G]\d|[1-9]\d?\.\d))({LIST})(?=:|,| |$)")
MIRROR = re.compile(rf", (?=[A-G]\d|[1-9]\d?\.\d)({LIST}) ?$")  # of a string of passes.def
HEADING = re.compile(r"^#+ +(?:Part )?((?:[A-G]?\d+(?:\.\d+)*|[A-G])(?=[.: ])\.?)? *(.*)$", re.MULTILINE)
PATH = re.compile(r"(?<![\w/.<@$\"+*-])((?:[\w.*{},-]+/)+[\w.*{},-]*)")
NAME = re.compile(r"(?<![\w/.<*$\"`:-])([a-z][\w-]*\.(?:h|cpp|def|py|txt))\b")
LINK = re.compile(r"\]\(([^)\s]+)\)")
FUNCTION = re.compile(r"(?<![\w.:>])([a-z][a-z0-9]*(?:_[a-z0-9]+)*)\(\)")
SETTING = re.compile(r"\bVITRINE_[A-Z_]+\b")
C_TOKEN = re.compile(r'R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/', re.DOTALL)


class Text:
    """Words that may cite: a comment with its neighbours, an effect, a document. Knows the line of each character."""

    def __init__(self, pieces, kind="comment"):
        self.kind = kind
        self.starts, self.text = [], ""
        for line, piece in pieces:
            self.starts.append((len(self.text), line))
            self.text += piece + " "

    def line(self, position):
        return next(line for start, line in reversed(self.starts) if start <= position)


def joined(comments):
    """Texts of (line, words, is the line's only content) comments: those of lines below each other are one."""
    pieces = []
    for line, words, alone in comments:
        if pieces and not (alone and line == pieces[-1][0] + 1):
            yield Text(pieces)
            pieces = []
        pieces.append((line, words))
    if pieces:
        yield Text(pieces)


def c_texts(source):
    """Comments, and the strings of tables."""
    comments, effects = [], []
    for match in C_TOKEN.finditer(source):
        token, line = match.group(), source.count("\n", 0, match.start()) + 1
        alone = not source[source.rfind("\n", 0, match.start()) + 1:match.start()].strip()
        if token.startswith("//"):
            comments.append((line, token.lstrip("/<! ").rstrip(), alone))
        elif token.startswith("/*"):
            comments.append((line, token.strip("/* \n"), alone))
        elif token[0] == '"':
            effects.append(Text([(line, token[1:-1])], "effect"))
    return list(joined(comments)), effects


def python_texts(source):
    """Comments and documentation strings."""
    comments = []
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        alone = not token.line[:token.start[1]].strip()
        if token.type == tokenize.COMMENT:
            comments.append((token.start[0], token.string.lstrip("#! "), alone))
        elif token.type == tokenize.STRING and token.string.startswith('"""'):
            yield Text([(token.start[0] + n, words) for n, words in enumerate(token.string.split("\n"))])
    yield from joined(comments)


def hash_texts(source):
    """Comments that begin with '#', of CMake, shell and data files."""
    comments = []
    for number, line in enumerate(source.splitlines(), 1):
        match = re.search(r"(?:^|\s)#(?!!)\s?(.*)", line)
        if match:
            comments.append((number, match.group(1), not line[:match.start()].strip()))
    return joined(comments)


def readable(document, unread):
    """Its words without code blocks and without these sections; lines keep their numbers."""
    kept, section, code = [], "", False
    for line in document.split("\n"):
        heading = re.match(r"## (\d+)?", line)
        section = (heading.group(1) or "") if heading else section
        fence = line.startswith("```")
        code ^= fence
        kept.append("" if code or fence or section in unread else line)
    return "\n".join(kept)


def texts_of(path, source, unread=()):
    """In the order of the file."""
    if path.suffix == ".md":
        return [Text(list(enumerate(readable(source, unread).split("\n"), 1)), "document")]
    if path.suffix in C_FILES:
        comments, effects = c_texts(source)
        texts = comments + (effects if path.suffix == ".def" else [])
    else:
        texts = list(python_texts(source) if path.suffix == ".py" else hash_texts(source))
    return sorted(texts, key=lambda text: text.starts[0][1])


def slug(heading):
    """As code hosts make it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower().replace("`", "")).replace(" ", "-")


class Document:
    def __init__(self, source):
        headings = list(HEADING.finditer(source))
        ends = [h.start() for h in headings[1:]] + [len(source)]
        self.sections = {h.group(1).rstrip("."): source[h.end():end] for h, end in zip(headings, ends) if h.group(1)}
        self.slugs = {slug(h.group().lstrip("# ")) for h in headings}

    def fault(self, item):
        """Why the citation of a section fails; None if it does not."""
        number, _, rest = item.partition(" ")
        if number not in self.sections:
            return f"no section {number}"
        if rest.startswith("step") and not re.search(rf"(?:^|\s){rest[5:]}\. ", self.sections[number]):
            return f"no step {rest[5:]} in section {number}"
        return None


class Tree:
    def __init__(self, root):
        self.root = root
        paths = [p for room in ROOMS for p in sorted((root / room).rglob("*")) if "__pycache__" not in p.parts]
        paths += [root / name for name in ROOT_FILES if (root / name).exists()]
        self.files = [p for p in paths if p.is_file() and p.suffix not in SKIPPED]
        self.places = {str(p.relative_to(root)) for p in paths} | set(ROOMS)
        self.names = {}
        for path in (p for p in paths if p.is_file()):
            self.names.setdefault(path.name, []).append(str(path.relative_to(root)))
        self.documents = {place: Document((root / place).read_text()) for place in self.places if place.endswith(".md")}
        rows = (root / DEVIATIONS).read_text() if DEVIATIONS in self.places else ""
        self.rows = set(re.findall(r"^\| ([\w-]+) \|", rows, re.MULTILINE))
        code = "".join(p.read_text(errors="replace") for p in self.files if p.suffix != ".md")
        self.cases = set(re.findall(r'"(deviation\.[a-z0-9_]+)', code))
        self.settings = set(SETTING.findall(code))
        self.words = set(re.findall(r"\b[a-z]\w*", re.sub(r"//[^\n]*", "", code)))

    def document(self, name, where):
        """Its place, or None: as a path, in docs/, or the only one of that name."""
        for place in (name, f"docs/{name}", str((pathlib.PurePosixPath(where).parent / name))):
            place = str(pathlib.PurePosixPath(*[p for p in pathlib.PurePosixPath(place).parts if p != "."]))
            if place in self.documents:
                return place
        if name.startswith("../"):
            return self.document(name[3:], "")
        found = [place for place in self.documents if place.endswith("/" + name)]
        return found[0] if len(found) == 1 else None

    def exists(self, path, where):
        """Relative to the root, to the folder of the file `where`, or to one above."""
        folders = [""] + [str(p) + "/" for p in pathlib.PurePosixPath(where).parents if str(p) != "."]
        for alternative in alternatives(path.rstrip("/")):
            if not any(self.matches(folder + alternative) for folder in folders):
                return False
        return True

    def matches(self, path):
        return path in self.places or ("*" in path and any(fnmatch.fnmatchcase(p, path) for p in self.places))


def alternatives(path):
    """a.{h,cpp} is two paths."""
    match = re.search(r"\{([^}]*)\}", path)
    if not match:
        return [path]
    return [a for part in match.group(1).split(",") for a in alternatives(path[:match.start()] + part + path[match.end():])]


def items(words):
    return re.findall(ITEM, words)


class Reader:
    """Reads the texts of one file and yields (line, fault)."""

    def __init__(self, tree, where):
        self.tree, self.where = tree, where
        self.named = where if where in tree.documents and tree.documents[where].sections else None

    def faults(self, text):
        found = [*self.documents(text), *self.rows(text), *self.paths(text), *self.functions(text)]
        if text.kind == "document":
            found += [*self.links(text), *self.within(text), *self.cases(text), *self.settings(text)]
        return [(text.line(position), fault) for position, fault in sorted(found)]

    def documents(self, text):
        """Documents, and the short citations behind each of them, in their order."""
        own = text.kind == "document"
        marks = [(m.start(), True, m) for m in DOCUMENT.finditer(text.text)]
        if not own:
            marks += [(m.start(), False, m) for m in SHORT.finditer(text.text)]
        if text.kind == "effect":
            marks += [(m.start(), False, m) for m in (EFFECT.match(text.text), MIRROR.search(text.text)) if m]
        for position, long, match in sorted(marks, key=lambda mark: mark[0]):
            if long:
                yield from self.document(position, match, own)
            elif self.named is None:
                yield position, f"{match.group().strip('(')}: the file names no document above"
            else:
                yield from self.sections(position, self.named, match.group(1))

    def document(self, position, match, own):
        name, sections = match.groups()
        place = self.tree.document(name, self.where)
        if place is None:
            if not own or "/" in name or not TELLS_OF_OTHERS.match(self.where):
                yield position, f"there is no document {name}"
            return
        if self.tree.documents[place].sections and not own:
            self.named = place
        if sections:
            yield from self.sections(position, place, sections)

    def sections(self, position, place, words):
        for item in items(words):
            fault = self.tree.documents[place].fault(item)
            if fault:
                yield position, f"{place} has {fault}"

    def rows(self, text):
        for match in ROWS.finditer(text.text):
            for row in re.findall(ROW, match.group(1)):
                if row not in self.tree.rows:
                    yield match.start(), f"deviations.md has no row {row}"

    def cases(self, text):
        for match in CASE.finditer(text.text if self.where == DEVIATIONS else ""):
            if match.group(1) not in self.tree.cases:
                yield match.start(), f"there is no case {match.group(1)}"

    def settings(self, text):
        """Environment variables, macros and build options."""
        for match in SETTING.finditer(text.text):
            if match.group() not in self.tree.settings and match.group() not in PLANNED.get(self.where, ()):
                yield match.start(), f"nothing reads {match.group()}"

    def functions(self, text):
        for match in FUNCTION.finditer(text.text):
            if match.group(1) not in self.tree.words:
                yield match.start(), f"there is no {match.group()}"

    def within(self, text):
        """Sections of the document itself."""
        own = self.tree.documents[self.where]
        for match in WITHIN.finditer(text.text) if own.sections else ():
            for item in items(match.group(1)):
                if own.fault(item):
                    yield match.start(), f"{own.fault(item)} here"

    def paths(self, text):
        if text.kind == "effect" and not PATH.match(text.text):
            return
        others = TELLS_OF_OTHERS.match(self.where) is not None
        code = re.finditer(r"`([^`]+)`", text.text)
        for position, words in ((m.start(1), m.group(1)) for m in code) if text.kind == "document" else [(0, text.text)]:
            for match in PATH.finditer(words):
                path = match.group(1).rstrip(".,-")
                if self.is_path(path, others) and not self.tree.exists(path, self.where):
                    yield position + match.start(), f"there is no {path}"
            for match in () if others else NAME.finditer(words):
                if match.group(1) not in self.tree.names and not EXTERNAL.fullmatch(match.group(1)):
                    yield position + match.start(), f"no file is called {match.group(1)}"

    def is_path(self, path, others):
        if path.startswith(PLANNED.get(self.where, ()) + EXTERNAL_FOLDERS):
            return False
        if path.split("/")[0] in ROOMS and path.count("/") + (not path.endswith("/")) > 1:
            return True
        return not others and re.search(r"[\w*}]\.(?:h|cpp|def|py|txt|\{[\w,]+\})$", path) is not None

    def links(self, text):
        for match in LINK.finditer(text.text):
            target, _, heading = match.group(1).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            place = self.where if not target else resolved(self.where, target)
            if target and place not in self.tree.places and not (self.tree.root / place).exists():
                yield match.start(), f"the link {match.group(1)} leads nowhere"
            elif heading and place in self.tree.documents and heading not in self.tree.documents[place].slugs:
                yield match.start(), f"{place} has no heading #{heading}"


def resolved(where, target):
    """A path relative to the folder of `where`, from the root."""
    parts = list(pathlib.PurePosixPath(where).parent.parts)
    for part in pathlib.PurePosixPath(target).parts:
        if part == ".." and parts:
            parts.pop()
        elif part != ".":
            parts.append(part)
    return "/".join(parts)


def faults_of(root):
    tree = Tree(root)
    for path in tree.files:
        where = str(path.relative_to(root))
        reader = Reader(tree, where)
        for text in texts_of(path, path.read_text(errors="replace"), NOT_READ.get(where, ())):
            for line, fault in reader.faults(text):
                yield f"{where}:{line}: {fault}"


def main():
    faults = list(faults_of(pathlib.Path(sys.argv[1]).resolve()))
    for fault in faults:
        print(f"FAULT {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
