/** The wall screens of a site: where each hangs, when it was last seen, and its end; a new one's link, shown once. */
import { Button, Modal, NativeSelect, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { Plus } from "lucide-react";
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { MadeWallScreen, WallScreen } from "@/api/types";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import { SecretField } from "@/design/SecretField";
import { useNow } from "@/design/useNow";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatAgo, formatMoment } from "@/i18n/format";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { tellRefusal, useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import { TableSkeleton } from "../TableSkeleton";
import { useShownOnce } from "../useShownOnce";
import { EndButton } from "./EndButton";
import { useMakeWallScreen, useTurnOff, useWallScreens } from "./people";
import styles from "./settings.module.css";

const DAYS = [7, 30, 90, 365, 1825];
const COLUMNS = ["name", "seen", "ends", "by", "act"];

interface RowProps {
  screen: WallScreen;
  turnOff: () => void;
  busy: boolean;
  afterwards: () => HTMLElement | null;
}

function Row({ screen, turnOff, busy, afterwards }: RowProps) {
  const { t } = useTranslation();
  const now = useNow();
  return (
    <tr data-over={screen.expired || undefined}>
      <td className={pages.strong}>{screen.name}</td>
      <td className={pages.nowrap}>{screen.seen_at ? formatAgo(screen.seen_at, now) : t("wall.admin.never")}</td>
      <td className={pages.nowrap}>{screen.expired ? t("wall.admin.expired") : formatMoment(screen.expires_at)}</td>
      <td className={pages.optional}>{screen.made_by || "–"}</td>
      <td>
        <EndButton
          label={t("wall.admin.offLabel", { name: screen.name })}
          words={t("wall.admin.off")}
          busy={busy}
          end={turnOff}
          afterwards={afterwards}
        />
      </td>
    </tr>
  );
}

function NewScreen({
  slug,
  onMade,
  onClose,
}: {
  slug: string;
  onMade: (made: MadeWallScreen) => void;
  onClose: () => void;
}) {
  const { t } = useTranslation();
  useReturnFocus();
  const [name, setName] = useState("");
  const [days, setDays] = useState(365);
  const make = useMakeWallScreen(slug, useTellUnseen());
  return (
    <Modal opened onClose={onClose} title={t("wall.admin.form")} size={480}>
      <form
        className={pages.form}
        onSubmit={(event) => {
          event.preventDefault();
          // The link is shown also to who has closed the form before it came: it is shown this one time.
          make.mutateAsync({ name: name.trim(), days }, { onSuccess: onClose }).then(onMade, () => undefined);
        }}
      >
        <p className={styles.hint}>{t("wall.admin.about")}</p>
        <TextInput
          label={t("wall.admin.name")}
          placeholder={t("wall.admin.namePlaceholder")}
          maxLength={100}
          required
          withAsterisk={false}
          data-autofocus
          value={name}
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <NativeSelect
          label={t("wall.admin.days")}
          value={String(days)}
          data={DAYS.map((count) => ({ value: String(count), label: t("wall.admin.daysOf", { count }) }))}
          onChange={(event) => setDays(Number(event.currentTarget.value))}
        />
        {make.error ? <p role="alert">{problemText(make.error, t("shell.problem.screen"))}</p> : null}
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("people.cancel")}
          </Button>
          <Button type="submit" loading={make.isPending} disabled={!name.trim()}>
            {t("wall.admin.make")}
          </Button>
        </div>
      </form>
    </Modal>
  );
}

function LinkOnce({ made, onClose }: { made: MadeWallScreen; onClose: () => void }) {
  const { t } = useTranslation();
  return (
    <Modal opened onClose={onClose} closeOnEscape={false} title={t("wall.admin.shown", { name: made.name })} size={560}>
      <div className={pages.form}>
        <p>{t("wall.admin.once")}</p>
        <SecretField
          label={t("people.shown.field")}
          value={made.link}
          copy={t("people.shown.copy")}
          copied={t("people.shown.copied")}
        />
        <Button onClick={onClose}>{t("people.shown.close")}</Button>
      </div>
    </Modal>
  );
}

interface TableProps {
  slug: string;
  screens: readonly WallScreen[];
  /** Who has the focus when a screen was turned off. */
  afterwards: () => HTMLElement | null;
}

function Table({ slug, screens, afterwards }: TableProps) {
  const { t } = useTranslation();
  const off = useTurnOff(slug);
  /** Each answer is told, also where another screen is turned off meanwhile. */
  const turnOff = ({ id, name }: WallScreen) =>
    off.mutateAsync(id).then(
      () => notifications.show({ message: t("wall.admin.turnedOff", { name }) }),
      (error: Error) => tellRefusal(error, t),
    );
  return (
    <div className={pages.scroll}>
      <table className={pages.table}>
        <thead>
          <tr>
            {COLUMNS.map((column) => (
              <th key={column} scope="col" className={column === "by" ? pages.optional : undefined}>
                <span className={column === "act" ? "visually-hidden" : undefined}>
                  {t(`wall.admin.column.${column}`)}
                </span>
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {screens.map((screen) => (
            <Row
              key={screen.id}
              screen={screen}
              turnOff={() => void turnOff(screen)}
              busy={off.isPending && off.variables === screen.id}
              afterwards={afterwards}
            />
          ))}
        </tbody>
      </table>
    </div>
  );
}

export function WallScreens({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const screens = useWallScreens(slug);
  const [making, setMaking] = useState(false);
  const links = useShownOnce<MadeWallScreen>();
  const heading = useRef<HTMLHeadingElement>(null);
  if (screens.isLoadingError) return <LoadProblem error={screens.error} again={() => void screens.refetch()} />;
  if (!screens.data) return <TableSkeleton />;
  return (
    <Panel className={styles.section} aria-label={t("wall.admin.title")}>
      <div className={styles.head}>
        <h2 ref={heading} tabIndex={-1}>
          {t("wall.admin.title")}
        </h2>
        <Chip>{screens.data.filter((each) => !each.expired).length}</Chip>
        <Button
          className={styles.last}
          size="xs"
          variant="default"
          leftSection={<Plus size={15} aria-hidden="true" />}
          onClick={() => setMaking(true)}
        >
          {t("wall.admin.new")}
        </Button>
      </div>
      {screens.data.length === 0 ? (
        <p className={styles.none}>{t("wall.admin.none")}</p>
      ) : (
        <Table slug={slug} screens={screens.data} afterwards={() => heading.current} />
      )}
      {making ? <NewScreen slug={slug} onMade={links.show} onClose={() => setMaking(false)} /> : null}
      {links.shown ? <LinkOnce key={links.shown.id} made={links.shown} onClose={links.next} /> : null}
    </Panel>
  );
}
