#!/usr/bin/env python3
"""Man pages and completions, made from what `pliant --help` and `pliant VERB --help` print.
Usage: from_help.py PLIANT FOLDER: writes FOLDER/man/*.1.gz, FOLDER/pliant (bash), FOLDER/_pliant (zsh)"""
import gzip
import os
import re
import subprocess
import sys

pliant, folder = sys.argv[1:]


def help_of(*verb):
    environment = dict(os.environ, COLUMNS="80", LC_ALL="C.UTF-8")
    return subprocess.run([pliant, *verb, "--help"], check=True, text=True, stdout=subprocess.PIPE,
                          env=environment).stdout


def sections(text):
    """[(title, lines)] after the first line, which is the summary."""
    found, title = [], ""
    for line in text.splitlines()[1:]:
        match = re.fullmatch(r"(\w+):", line)
        if match:
            title = match[1]
            found.append((title, []))
        elif line.startswith("Usage: "):
            found.append(("Usage", [line[7:]]))
        elif line.strip() and found:
            found[-1][1].append(line)
    return found


def entries(lines):
    """[(term, description)]: two columns, the second begins after two blanks, or on a line of its own."""
    found = []
    for line in lines:
        match = re.match(r"^ {2}(\S.*?)(?: {2,}(.*))?$", line)
        if match and not line.startswith("   "):
            found.append([match[1], match[2] or ""])
        elif found:
            found[-1][1] = (found[-1][1] + " " + line.strip()).strip()
    return found


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in ".'" else text


def man_page(name, text, see):
    summary = text.splitlines()[0]
    short = summary.split(": ", 1)[-1] if name == "pliant" else summary
    page = [f'.TH {name.upper().replace("-", chr(92) + "-")} 1 "" "pliant {version}" "Pliant"', ".SH NAME",
            f"{roff(name)} \\- {roff(short)}"]
    for title, lines in sections(text):
        if title == "Usage":
            page += [".SH SYNOPSIS", ".B " + roff(lines[0])]
        elif title == "Examples":
            page += [".SH EXAMPLES", ".nf", *(roff(line) for line in lines), ".fi"]
        else:
            page.append(".SH " + {"Positionals": "ARGUMENTS", "Subcommands": "COMMANDS"}.get(title, title.upper()))
            for term, description in entries(lines):
                page += [".TP", ".B " + roff(term), roff(description)]
    page += [".SH SEE ALSO", *(f".BR {roff(each)} (1)" for each in see)]
    return "\n".join(page) + "\n"


def write(path, data):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


def options_of(text):
    """[(option, description)] of long options."""
    lines = [line for title, lines in sections(text) if title == "Options" for line in lines]
    return [(option, description) for term, description in entries(lines)
            for option in re.findall(r"--[a-z-]+", term.split(" ")[0])]


version = subprocess.run([pliant, "--version"], check=True, text=True, stdout=subprocess.PIPE).stdout.split()[-1]
top = help_of()
verbs = [(term, description) for title, lines in sections(top) if title == "Subcommands"
         for term, description in entries(lines)]
texts = {verb: help_of(verb) for verb, _ in verbs}
pages = {"pliant": man_page("pliant", top, [f"pliant-{verb}" for verb, _ in verbs])}
pages |= {f"pliant-{verb}": man_page(f"pliant-{verb}", text, ["pliant"]) for verb, text in texts.items()}
for name, page in pages.items():
    write(f"{folder}/man/{name}.1.gz", gzip.compress(page.encode(), 9, mtime=0))

bash = ["# Completion of pliant for bash, made from its --help.", "_pliant() {", "  local word=${COMP_WORDS[COMP_CWORD]} verb=${COMP_WORDS[1]} options=",
        "  if [[ $COMP_CWORD -eq 1 ]]; then",
        f"    COMPREPLY=($(compgen -W '{' '.join(verb for verb, _ in verbs)} --help --version' -- \"$word\"))", "    return",
        "  fi", "  case $verb in"]
bash += [f"    {verb}) options='{' '.join(option for option, _ in options_of(text))}' ;;" for verb, text in texts.items()]
bash += ["  esac", "  if [[ $word == -* ]]; then", "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))", "    return", "  fi",
         "  COMPREPLY=($(compgen -f -- \"$word\"))",
         "  if [[ $verb == run || $verb == edit ]]; then",
         "    COMPREPLY+=($(compgen -W \"$(pliant run --list 2>/dev/null | awk '/^ *[a-z_]+ /{print $1}')\" -- \"$word\"))",
         "  fi",
         "}", "complete -o filenames -F _pliant pliant"]
write(f"{folder}/pliant", ("\n".join(bash) + "\n").encode())


def zsh_text(text):
    return text.replace("'", "'\\''").replace("[", "(").replace("]", ")").replace(":", "\\:")


zsh = ["#compdef pliant", "# Completion of pliant for zsh, made from its --help.", "_pliant() {", "  local -a verbs", "  verbs=("]
zsh += [f"    '{verb}:{zsh_text(description)}'" for verb, description in verbs]
zsh += ["  )", "  if (( CURRENT == 2 )); then", "    _describe verb verbs", "    return", "  fi", "  case $words[2] in"]
for verb, text in texts.items():
    zsh.append(f"    {verb}) _arguments " + " ".join(
        f"'{option}[{zsh_text(description)}]'" for option, description in options_of(text)) + " '*:file:_files' ;;")
zsh += ["  esac", "}", '_pliant "$@"']
write(f"{folder}/_pliant", ("\n".join(zsh) + "\n").encode())
