import { Workflow } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { LibraryFunction } from "@/api/types";
import { Avatar } from "@/design/Avatar";
import { Chip, type Tone } from "@/design/Chip";
import { unitSign } from "@/i18n/units";
import { ownEntry } from "@/design/ownEntry";
import { nameOf } from "../people";
import { FitLine } from "./Fit";
import { FunctionPicture } from "./FunctionPicture";
import { VisibilitySign } from "./Sharing";
import styles from "./library.module.css";

const TONES: Readonly<Record<string, Tone>> = {
  device: "machine",
  machine: "machine",
  place: "brand",
  text: "logic",
  number: "quiet",
  integer: "quiet",
};

export function ParameterType({ parameter }: { parameter: LibraryFunction["parameters"][number] }) {
  const { t } = useTranslation();
  const known = t(`library.type.${parameter.type}`, { defaultValue: parameter.type });
  return (
    <Chip tone={ownEntry(TONES, parameter.type) ?? "quiet"}>
      {parameter.unit ? `${known}, ${unitSign(parameter.unit)}` : known}
    </Chip>
  );
}

export function FunctionCard({ slug, item, chosen }: { slug: string; item: LibraryFunction; chosen: boolean }) {
  const { t } = useTranslation();
  const author = nameOf(item.author);
  return (
    <li className={styles.card} data-chosen={chosen || undefined}>
      <div className={styles.picture}>
        <FunctionPicture item={item} />
      </div>
      <div className={styles.cardText}>
        <div className={styles.cardHead}>
          <Link to={`/sites/${slug}/library/${item.id}`} className={styles.name} aria-current={chosen || undefined}>
            {item.name}
          </Link>
          <Chip mono>{t("library.version", { version: item.version })}</Chip>
          <VisibilitySign item={item} />
        </div>
        <div className={styles.parameters}>
          {item.parameters.map((parameter) => (
            <span key={parameter.name}>
              <code>{parameter.name}</code>
              <ParameterType parameter={parameter} />
            </span>
          ))}
        </div>
        <p>{item.description}</p>
        <FitLine item={item} />
        <div className={styles.cardFoot}>
          {author ? <Avatar name={author} size={20} /> : null}
          <span>{[author, item.site === slug ? "" : item.site].filter(Boolean).join(", ")}</span>
          <span className={styles.used}>
            <Workflow size={14} aria-hidden="true" />
            {t("library.programs", { count: item.used_in })}
          </span>
        </div>
      </div>
    </li>
  );
}
