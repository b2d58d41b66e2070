/** The list under an expression's text box; readings show what they are now. */
import { useEffect, useRef } from "react";
import { useTranslation } from "react-i18next";
import { withUnit } from "@/program/words/stepWords";
import { rowPress } from "@/shell/palette/rowPress";
import { useOpenProgram } from "../../state/context";
import classes from "./expression.module.css";
import { useReading } from "./Readings";
import type { Suggestion } from "./suggestions";

export function SuggestionList({
  id,
  label,
  suggestions,
  marked,
  choose,
}: {
  id: string;
  label: string;
  suggestions: readonly Suggestion[];
  marked: number;
  choose: (chosen: Suggestion) => void;
}) {
  return (
    <ul id={`${id}-list`} role="listbox" aria-label={label} className={classes.list}>
      {suggestions.map((each, index) => (
        <Option
          key={`${each.kind} ${each.label}`}
          id={`${id}-${index}`}
          suggestion={each}
          marked={index === marked}
          choose={() => choose(each)}
        />
      ))}
    </ul>
  );
}

function Option({
  id,
  suggestion,
  marked,
  choose,
}: {
  id: string;
  suggestion: Suggestion;
  marked: boolean;
  choose: () => void;
}) {
  const { t } = useTranslation();
  const item = useRef<HTMLLIElement>(null);
  useEffect(() => {
    if (marked) item.current?.scrollIntoView({ block: "nearest" });
  }, [marked]);
  return (
    <li id={id} ref={item} role="option" aria-selected={marked} className={classes.option} {...rowPress(choose)}>
      <code>{suggestion.label}</code>
      {suggestion.device && suggestion.property ? (
        <Now device={suggestion.device} property={suggestion.property} />
      ) : (
        <span>{t(`expression.${suggestion.kind}`)}</span>
      )}
    </li>
  );
}

function Now({ device, property }: { device: string; property: string }) {
  const { devices } = useOpenProgram();
  const { t } = useTranslation();
  const facts = devices.find((each) => each.id === device)?.properties.find((each) => each.name === property);
  const value = useReading(device, property);
  return <span>{value === null ? t("expression.reading") : withUnit(String(value), facts?.unit ?? "")}</span>;
}
