/** The text box of an expression, with a list of what may be written next (ARIA combobox with a list). */
import { TextInput } from "@mantine/core";
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useStepEditor } from "../fields/stepEditor";
import { ColumnMark } from "./ColumnMark";
import classes from "./expression.module.css";
import type { Wanted } from "./literal";
import { SuggestionList } from "./SuggestionList";
import { useCombobox } from "./useCombobox";
import type { Expression } from "./useExpression";

interface ExpressionInputProps {
  id: string;
  note: string | undefined;
  bad: boolean;
  expression: Expression;
  wanted: Wanted;
  /** What a bare number is in, as people read it; empty: nothing. */
  unit: string;
  placeholder?: string;
}

/** What is written here is no prose. */
const AS_CODE = { spellCheck: false, autoComplete: "off", autoCapitalize: "off" } as const;
const BARE_NUMBER = /^-?[\d.,]*$/;

export function ExpressionInput(props: ExpressionInputProps) {
  const { id, expression, unit } = props;
  const { t } = useTranslation();
  const { disabled } = useStepEditor();
  const input = useRef<HTMLInputElement>(null);
  const [scrolled, setScrolled] = useState(0);
  const box = useCombobox(expression, props.wanted, input);
  const listed = box.shown.length > 0;
  const shownUnit = unit && BARE_NUMBER.test(expression.text.trim()) ? unit : "";
  return (
    <div className={classes.combobox}>
      <TextInput
        id={id}
        ref={input}
        // oxlint-disable-next-line jsx-a11y/role-has-required-aria-props -- listLinks gives them
        role="combobox"
        aria-autocomplete="list"
        aria-haspopup="listbox"
        {...listLinks(id, listed, box.marked)}
        aria-describedby={props.note}
        aria-invalid={props.bad}
        error={props.bad}
        classNames={{ input: classes.input, section: classes.unit }}
        rightSection={shownUnit || null}
        rightSectionWidth={16 + 8 * shownUnit.length}
        rightSectionPointerEvents="none"
        disabled={disabled}
        placeholder={props.placeholder ?? t("expression.placeholder")}
        {...AS_CODE}
        value={expression.text}
        onScroll={(event) => setScrolled(event.currentTarget.scrollLeft)}
        {...box.handlers}
      />
      {expression.column === null ? null : (
        <ColumnMark input={input} text={expression.text} column={expression.column} scrolled={scrolled} />
      )}
      {listed ? (
        <SuggestionList
          id={id}
          label={t("expression.suggestions")}
          suggestions={box.shown}
          marked={box.marked}
          choose={box.choose}
        />
      ) : null}
    </div>
  );
}

/** How the text box names its list and what is marked in it. */
function listLinks(id: string, listed: boolean, marked: number) {
  return {
    "aria-expanded": listed,
    "aria-controls": listed ? `${id}-list` : undefined,
    "aria-activedescendant": marked >= 0 ? `${id}-${marked}` : undefined,
  };
}
