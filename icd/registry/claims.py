"""Reads the claims of manifest/: lines of fields separated by ';' (the last one may contain more), '#' starts a comment, blank lines are ignored."""
import re
from fnmatch import fnmatchcase as fnmatch
from dataclasses import dataclass

# Words of manifest/formats and the VK_FORMAT_FEATURE_*_BIT that they stand for.
IMAGE_WORDS = {"sampled": "SAMPLED_IMAGE", "linear": "SAMPLED_IMAGE_FILTER_LINEAR", "minmax": "SAMPLED_IMAGE_FILTER_MINMAX",
               "storage": "STORAGE_IMAGE", "atomic": "STORAGE_IMAGE_ATOMIC", "color": "COLOR_ATTACHMENT", "blend": "COLOR_ATTACHMENT_BLEND",
               "depth_stencil": "DEPTH_STENCIL_ATTACHMENT",
               "midpoint": "MIDPOINT_CHROMA_SAMPLES", "cosited": "COSITED_CHROMA_SAMPLES", "disjoint": "DISJOINT",
               "chroma_linear": "SAMPLED_IMAGE_YCBCR_CONVERSION_LINEAR_FILTER",
               "chroma_separate": "SAMPLED_IMAGE_YCBCR_CONVERSION_SEPARATE_RECONSTRUCTION_FILTER",
               "blit_src": "BLIT_SRC", "blit_dst": "BLIT_DST", "shading_rate": "FRAGMENT_SHADING_RATE_ATTACHMENT"}
BUFFER_WORDS = {"uniform_texel": "UNIFORM_TEXEL_BUFFER", "storage_texel": "STORAGE_TEXEL_BUFFER",
                "storage_texel_atomic": "STORAGE_TEXEL_BUFFER_ATOMIC", "vertex": "VERTEX_BUFFER"}


@dataclass
class Limit:
    value: str
    minimum: str  # what the specification requires, or '-'
    reason: str
    line: str     # file:line, for messages


def rows(path):
    """Yields (fields, 'file:line') of every line that says something."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        line = re.sub(r"(^|\s)#.*", "", line).strip()
        if line:
            yield [f.strip() for f in line.split(";", 2)], f"{path.name}:{number}"


class Claims:
    def __init__(self, folder):
        self.folder = folder
        self.limits = {}
        for file in ("device", "limits"):
            for fields, where in rows(folder / file):
                name, value = (f.strip() for f in fields[0].split("=", 1))
                self._once(name, self.limits, where)
                minimum = fields[1] if len(fields) > 1 else "-"
                self.limits[name] = Limit(value, minimum, fields[2] if len(fields) > 2 else "", where)
        self.features = {}
        for fields, where in rows(folder / "features"):
            self._once(fields[0], self.features, where)
            self.features[fields[0]] = self._tests(fields, 1, where)
        self.extensions = {}
        for fields, where in rows(folder / "extensions"):
            self._once(fields[0], self.extensions, where)
            if len(fields) < 2 or not fields[1].isdigit():
                raise SystemExit(f"{where}: expected 'name ; spec version ; tests'")
            self.extensions[fields[0]] = (int(fields[1]), self._tests(fields, 2, where))
        self.formats = {}
        for fields, where in rows(folder / "formats"):
            self._once(fields[0], self.formats, where)
            fields += [""] * (3 - len(fields))
            image = [IMAGE_WORDS[w] for w in self._words(fields[1], IMAGE_WORDS, where)]
            buffer = [BUFFER_WORDS[w] for w in self._words(fields[2], BUFFER_WORDS, where)]
            self.formats[fields[0]] = (image + ["TRANSFER_SRC", "TRANSFER_DST"] if image else [], buffer)
        self.api_version = self.limits["apiVersion"].value

    def limit(self, name):
        """The row of a name: its own, or the first with a '*' that fits. Null: none."""
        if name in self.limits:
            return self.limits[name]
        return next((row for pattern, row in self.limits.items() if "*" in pattern and fnmatch(name, pattern)), None)

    @staticmethod
    def _once(name, known, where):
        if name in known:
            raise SystemExit(f"{where}: {name} is claimed twice")

    @staticmethod
    def _words(text, known, where):
        for word in text.split():
            if word not in known:
                raise SystemExit(f"{where}: unknown format feature {word}")
        return text.split()

    @staticmethod
    def _tests(fields, index, where):
        if len(fields) <= index or not fields[index]:
            raise SystemExit(f"{where}: a claim names the tests that back it")
        return fields[index]
