"""``cellc completion``: the script that makes a shell complete cellc's commands."""

from __future__ import annotations

import click
from click.shell_completion import BashComplete, FishComplete, ZshComplete

from cellc.contract.printing import show_document

# Readline takes `pick/delay:arm@1` and `arm=MODEL` for several words, and puts in only what follows the last mark of
# them; click asks about the last piece alone.
_BASH = """\
%(complete_func)s() {
    local line=${COMP_LINE:0:COMP_POINT} piece word breaks cut="" type value i
    local -a whole=()
    for ((i = 0; i <= COMP_CWORD; i++)); do
        piece=${COMP_WORDS[i]}
        if ((i > 0)) && [[ $line != [[:space:]]* ]]; then whole[-1]+=$piece; else whole+=("$piece"); fi
        line=${line#"${line%%%%[![:space:]]*}"}
        line=${line#"$piece"}
    done
    word=${whole[-1]}
    breaks=${COMP_WORDBREAKS//[^:@=]/}
    [[ -n $breaks ]] && cut=${word%%"${word##*[$breaks]}"}
    COMPREPLY=()
    while IFS=, read -r type value; do
        case $type in
            dir) compopt -o dirnames ;;
            file) compopt -o default ;;
            plain) COMPREPLY+=("${value#"$cut"}") ;;
        esac
    done < <(COMP_WORDS="${whole[*]}" COMP_CWORD=$((${#whole[@]} - 1)) %(complete_var)s=bash_complete "$1")
}

complete -o nosort -F %(complete_func)s %(prog_name)s
"""

# A word may have commas, as the codes of `--select` have.
_FISH = """\
function %(complete_func)s
    set -lx COMP_WORDS (commandline -cp)
    set -lx COMP_CWORD (commandline -t)
    for line in (env %(complete_var)s=fish_complete %(prog_name)s)
        set -l parts (string split --max 1 "," -- $line)
        switch $parts[1]
            case dir
                __fish_complete_directories $parts[2]
            case file
                __fish_complete_path $parts[2]
            case plain
                echo $parts[2]
        end
    end
end

complete --no-files --command %(prog_name)s --arguments "(%(complete_func)s)"
"""


class _Bash(BashComplete):
    source_template = _BASH


class _Fish(FishComplete):
    source_template = _FISH


_SHELLS = {"bash": _Bash, "zsh": ZshComplete, "fish": _Fish}


@click.command()
@click.argument("shell", type=click.Choice(list(_SHELLS)))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print the completion script of SHELL; add `eval "$(cellc completion bash)"` to its start-up file.

    \b
    cellc completion bash
    cellc completion fish > ~/.config/fish/completions/cellc.fish
    """
    show_document(_SHELLS[shell](context.find_root().command, {}, "cellc", "_CELLC_COMPLETE").source())
