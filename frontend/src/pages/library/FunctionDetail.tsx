/** One function: what it takes, what it does, and how to use it. */
import { Button, Menu } from "@mantine/core";
import { Download, SquareFunction, X } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useLibraryFunction, usePrograms } from "@/api/queries";
import type { LibraryFunction } from "@/api/types";
import { LoadProblem } from "@/shell/LoadProblem";
import { Panel } from "@/design/Panel";
import { formatAgo } from "@/i18n/format";
import { SourceView } from "../devices/description/SourceView";
import pages from "../pages.module.css";
import { nameOf } from "../people";
import { useNow } from "@/design/useNow";
import { FunctionPicture } from "./FunctionPicture";
import { ParameterType } from "./FunctionCard";
import { Sharing } from "./Sharing";
import styles from "./library.module.css";

function Parameters({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  if (item.parameters.length === 0) return <p className={pages.sub}>{t("pages.library.noParameters")}</p>;
  return (
    <Panel className={pages.scroll}>
      <table className={pages.table}>
        <thead>
          <tr>
            {["parameter", "type", "default"].map((column) => (
              <th key={column} scope="col">
                {t(`pages.library.column.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {item.parameters.map((parameter) => (
            <tr key={parameter.name}>
              <td>
                <code className={styles.strong}>{parameter.name}</code>
              </td>
              <td>
                <ParameterType parameter={parameter} />
              </td>
              <td>{parameter.default == null ? t("pages.library.asks") : JSON.stringify(parameter.default)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Panel>
  );
}

function UseInProgram({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  const programs = usePrograms(slug).data ?? [];
  return (
    <footer className={styles.foot}>
      <span>{t("pages.library.usedIn", { count: item.used_in })}</span>
      <Menu position="top-end" width={240}>
        <Menu.Target>
          <Button leftSection={<Download size={16} />} disabled={programs.length === 0}>
            {t("pages.library.use")}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>{t("pages.library.chooseProgram")}</Menu.Label>
          {programs.map((program) => (
            <Menu.Item key={program.id} component={Link} to={`/programs/${program.id}?import=${item.id}`}>
              {program.name}
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    </footer>
  );
}

function Body({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  return (
    <div className={styles.body}>
      {item.description ? <p>{item.description}</p> : null}
      <Panel className={styles.bigPicture}>
        <FunctionPicture item={item} />
      </Panel>
      <Parameters item={item} />
      <Sharing item={item} />
      {item.script ? (
        <section aria-labelledby="script">
          <h3 id="script" className={styles.section}>
            {t("pages.library.script")}
          </h3>
          <Panel className={styles.script}>
            <SourceView text={item.script} dialect="script" label={t("pages.library.script")} />
          </Panel>
        </section>
      ) : null}
    </div>
  );
}

export function FunctionDetail({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  const now = useNow();
  const full = useLibraryFunction(item.id);
  const shown = full.data ?? item;
  return (
    <aside className={styles.detail} aria-label={item.name}>
      <header className={styles.head}>
        <span className={styles.sign}>
          <SquareFunction size={20} aria-hidden="true" />
        </span>
        <div>
          <h2>{shown.name}</h2>
          <p>
            {[
              t("pages.library.version", { version: shown.version }),
              nameOf(shown.author),
              shown.site === slug ? "" : shown.site,
              t("pages.library.updated", { ago: formatAgo(shown.updated_at, now) }),
            ]
              .filter(Boolean)
              .join(", ")}
          </p>
        </div>
        <Link to={`/sites/${slug}/library`} aria-label={t("pages.close")} className={styles.close}>
          <X size={18} aria-hidden="true" />
        </Link>
      </header>
      {full.isLoadingError ? <LoadProblem error={full.error} again={() => void full.refetch()} /> : null}
      <Body item={shown} />
      <UseInProgram slug={slug} item={shown} />
    </aside>
  );
}
