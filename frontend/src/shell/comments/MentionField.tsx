/** A field for a comment's text; after an @ it offers the members of the site by name. */
import { Textarea } from "@mantine/core";
import { type KeyboardEvent, type RefObject, useId, useLayoutEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { rowPress } from "../palette/rowPress";
import classes from "./comments.module.css";
import { askedAt, type Named, offered, withName } from "./mentions";

const MOST_TEXT = 2000;

interface MentionFieldProps {
  label: string;
  value: string;
  people: readonly Named[];
  field: RefObject<HTMLTextAreaElement | null>;
  onChange: (value: string) => void;
  /** Ctrl+Enter. */
  onSubmit: () => void;
  /** Escape, where no list is open. */
  onLeave?: () => void;
}

export function MentionField(props: MentionFieldProps) {
  const { label, value, field, onChange } = props;
  const { t } = useTranslation();
  const id = useId();
  const offer = useOffer(props);
  return (
    <div className={classes.field}>
      <Textarea
        label={label}
        description={t("comments.hint")}
        value={value}
        ref={field}
        maxLength={MOST_TEXT}
        autosize
        minRows={2}
        maxRows={6}
        aria-autocomplete="list"
        aria-controls={offer.names.length > 0 ? id : undefined}
        aria-activedescendant={offer.names.length > 0 ? `${id}-${offer.at}` : undefined}
        onChange={(event) => {
          onChange(event.currentTarget.value);
          offer.look(event.currentTarget);
        }}
        onSelect={(event) => offer.look(event.currentTarget)}
        onBlur={offer.close}
        onKeyDown={offer.onKey}
      />
      {offer.names.length > 0 ? (
        <ul className={classes.offer} role="listbox" id={id} aria-label={t("comments.mention")}>
          {offer.names.map((person, at) => (
            <li
              key={person.id}
              id={`${id}-${at}`}
              role="option"
              aria-selected={at === offer.at}
              {...rowPress(() => offer.choose(person))}
            >
              {person.name}
            </li>
          ))}
        </ul>
      ) : null}
    </div>
  );
}

/** The names that fit what is typed after an @, and the one that Enter takes. */
function useOffer({ value, people, field, onChange, onSubmit, onLeave }: MentionFieldProps) {
  const [caret, setCaret] = useState<number | null>(null);
  const [chosen, setChosen] = useState(0);
  const goes = useRef<number | null>(null);
  const asked = caret === null ? null : askedAt(value, caret);
  const names = asked ? offered(asked, people) : [];
  const at = Math.min(chosen, Math.max(0, names.length - 1));
  useLayoutEffect(() => {
    if (goes.current !== null) field.current?.setSelectionRange(goes.current, goes.current);
    goes.current = null;
  }, [value, field]);
  const close = () => setCaret(null);
  const look = (element: HTMLTextAreaElement) => {
    setCaret(element.selectionStart === element.selectionEnd ? element.selectionStart : null);
  };
  const choose = (person: Named) => {
    if (!asked) return;
    const next = withName(value, asked, person);
    goes.current = next.caret;
    setChosen(0);
    close();
    onChange(next.text);
  };
  const take = (event: KeyboardEvent): boolean => {
    const person = names[at];
    if (!person || event.ctrlKey || event.metaKey) return false;
    if (event.key === "ArrowDown" || event.key === "ArrowUp")
      setChosen((at + (event.key === "ArrowDown" ? 1 : names.length - 1)) % names.length);
    else if (event.key === "Enter" || event.key === "Tab") choose(person);
    else if (event.key === "Escape") close();
    else return false;
    return true;
  };
  const onKey = (event: KeyboardEvent) => {
    const taken = take(event);
    const sends = !taken && event.key === "Enter" && (event.ctrlKey || event.metaKey);
    const leaves = !taken && event.key === "Escape" && onLeave !== undefined;
    if (!taken && !sends && !leaves) return;
    event.preventDefault();
    event.stopPropagation();
    if (sends) onSubmit();
    if (leaves) onLeave();
  };
  return { names, at, look, choose, close, onKey };
}
