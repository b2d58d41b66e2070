/** The text box of an expression, with a list of what may be written next (ARIA combobox with a list). */
import { TextInput } from "@mantine/core";
import { useRef, useState, type KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import { useStepEditor } from "../stepEditor";
import classes from "./expression.module.css";
import { SuggestionList } from "./SuggestionList";
import { suggest, take, type Suggestion } from "./suggestions";
import type { Expression } from "./useExpression";
import { useNames } from "./useNames";

interface Open {
  readonly caret: number;
  /** -1: none is marked, and Enter stores what is written. */
  readonly marked: number;
}

export function ExpressionInput({
  id,
  note,
  bad,
  expression,
  placeholder,
}: {
  id: string;
  note: string | undefined;
  bad: boolean;
  expression: Expression;
  placeholder?: string;
}) {
  const { t } = useTranslation();
  const { id: step, disabled } = useStepEditor();
  const [focused, setFocused] = useState(false);
  const [open, setOpen] = useState<Open | null>(null);
  const input = useRef<HTMLInputElement>(null);
  const names = useNames(step, focused && !disabled);
  const shown = open ? suggest(expression.text, open.caret, names) : [];
  const marked = open && open.marked < shown.length ? open.marked : -1;

  const choose = (chosen: Suggestion) => {
    if (!open) return;
    const next = take(expression.text, open.caret, chosen);
    expression.write(next.text);
    setOpen(null);
    requestAnimationFrame(() => input.current?.setSelectionRange(next.caret, next.caret));
  };
  const move = (by: number) => {
    const caret = input.current?.selectionStart ?? expression.text.length;
    if (!open) setOpen({ caret, marked: by > 0 ? 0 : -1 });
    else if (shown.length > 0)
      setOpen({ ...open, marked: (Math.max(marked, by > 0 ? -1 : 0) + by + shown.length) % shown.length });
  };
  const press = (event: KeyboardEvent) => {
    const chosen = shown[marked];
    if (event.key === "ArrowDown" || event.key === "ArrowUp") move(event.key === "ArrowDown" ? 1 : -1);
    else if (event.key === "Enter" && chosen) choose(chosen);
    else if (event.key === "Enter") expression.settle();
    else if (event.key === "Escape" && shown.length > 0) setOpen(null);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const listed = shown.length > 0;
  return (
    <div className={classes.combobox}>
      <TextInput
        id={id}
        ref={input}
        role="combobox"
        aria-autocomplete="list"
        aria-haspopup="listbox"
        aria-expanded={listed}
        aria-controls={listed ? `${id}-list` : undefined}
        aria-activedescendant={marked >= 0 ? `${id}-${marked}` : undefined}
        aria-describedby={note}
        aria-invalid={bad}
        error={bad}
        classNames={{ input: classes.input }}
        disabled={disabled}
        placeholder={placeholder ?? t("expression.placeholder")}
        spellCheck={false}
        autoComplete="off"
        autoCapitalize="off"
        value={expression.text}
        onChange={(event) => {
          const box = event.currentTarget;
          expression.write(box.value);
          setOpen({ caret: box.selectionStart ?? box.value.length, marked: -1 });
        }}
        onFocus={() => setFocused(true)}
        onBlur={() => {
          setFocused(false);
          setOpen(null);
          expression.settle();
        }}
        onKeyDown={press}
      />
      {listed ? (
        <SuggestionList
          id={id}
          label={t("expression.suggestions")}
          suggestions={shown}
          marked={marked}
          choose={choose}
        />
      ) : null}
    </div>
  );
}
