/** The list of a text box that completes: when it is open, what is marked in it, what the keys do. */
import { useQuery } from "@tanstack/react-query";
import { type ChangeEvent, type KeyboardEvent, type RefObject, useState } from "react";
import { api } from "@/api/client";
import { useOpenProgram } from "../../state/context";
import { useStepEditor } from "../fields/stepEditor";
import { choicesOf, type Wanted } from "./literal";
import { type LineName, suggest, suggestChoices, type Suggestion, take } from "./suggestions";
import type { Expression } from "./useExpression";

interface Open {
  readonly caret: number;
  /** -1: none is marked, and Enter stores what is written. */
  readonly marked: number;
  /** Opened without writing: everything that can be chosen is shown. */
  readonly all: boolean;
}

export function useCombobox(expression: Expression, wanted: Wanted, input: RefObject<HTMLInputElement | null>) {
  const { id: step, disabled } = useStepEditor();
  const [focused, setFocused] = useState(false);
  const [open, setOpen] = useState<Open | null>(null);
  const names = useNames(step, focused && !disabled);
  const choices = choicesOf(wanted);
  const { text } = expression;
  const chosen = open ? suggestChoices(text, choices, open.all) : [];
  const written = open && !(open.all && chosen.length > 0) ? suggest(text, open.caret, names) : [];
  const shown = [...chosen, ...written];
  const marked = open && open.marked < shown.length ? open.marked : -1;
  const caretNow = () => input.current?.selectionStart ?? text.length;

  const choose = (chosen: Suggestion) => {
    if (!open) return;
    const next = take(text, open.caret, chosen);
    expression.write(next.text);
    if (chosen.whole) expression.settle();
    setOpen(null);
    requestAnimationFrame(() => input.current?.setSelectionRange(next.caret, next.caret));
  };
  const move = (by: number) => {
    if (!open) setOpen({ caret: caretNow(), marked: by > 0 ? 0 : -1, all: true });
    else if (shown.length > 0)
      setOpen({ ...open, marked: (Math.max(marked, by > 0 ? -1 : 0) + by + shown.length) % shown.length });
  };
  /** True when the line is done with: the panel then gives the keyboard back to the map. */
  const enter = (): boolean => {
    const under = shown[marked];
    if (under) choose(under);
    else expression.settle();
    return !under || under.whole === true;
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") move(event.key === "ArrowDown" ? 1 : -1);
    else if (event.key === "Escape" && shown.length > 0) setOpen(null);
    else {
      if (event.key === "Escape") expression.takeBack();
      if (event.key !== "Enter" || enter()) return;
    }
    event.preventDefault();
    event.stopPropagation();
  };
  const onChange = (event: ChangeEvent<HTMLInputElement>) => {
    const box = event.currentTarget;
    expression.write(box.value);
    setOpen({ caret: box.selectionStart ?? box.value.length, marked: -1, all: false });
  };
  const onBlur = () => {
    setFocused(false);
    setOpen(null);
    expression.settle();
  };
  const onClick = () => {
    if (choices.length > 0 && !open) setOpen({ caret: caretNow(), marked: -1, all: true });
  };
  return { shown, marked, choose, handlers: { onChange, onKeyDown, onBlur, onClick, onFocus: () => setFocused(true) } };
}

export function useNames(step: string, wanted: boolean): readonly LineName[] {
  const { program, compiled } = useOpenProgram();
  const names = useQuery({
    queryKey: ["expression-names", program.id, step, compiled?.revision ?? 0],
    queryFn: () => api.post<{ names: LineName[] }>(`/programs/${program.id}/expression`, { step, names: true }),
    enabled: wanted,
    placeholderData: (before) => before,
  });
  return names.data?.names ?? [];
}
