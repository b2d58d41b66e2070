/** The tokens by which programs ask VIPO: one's own, for admins those of everybody at the site. */
import { Button, Modal } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { KeyRound, Plus } from "lucide-react";
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { missing } from "@/api/failed";
import { useSite } from "@/api/queries";
import type { MadeToken, Token } from "@/api/types";
import { Chip } from "@/design/Chip";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { useNow } from "@/design/useNow";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatAgo, formatMoment } from "@/i18n/format";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import { SettingsTabs } from "../settings/SettingsTabs";
import { TableSkeleton } from "../TableSkeleton";
import { useShownOnce } from "../useShownOnce";
import { NewToken, TokenShown } from "./NewToken";
import { useRevokeToken, useTokens } from "./tokens";
import styles from "./tokens.module.css";

const COLUMNS = ["name", "scopes", "person", "used", "until", "act"];
const OPTIONAL = new Set(["person", "used"]);

function Row({ token, now, revoke }: { token: Token; now: number; revoke: () => void }) {
  const { t } = useTranslation();
  return (
    <tr>
      <td className={pages.name}>
        <span className={pages.strong} title={token.name}>
          {token.name}
        </span>
      </td>
      <td>
        <span className={styles.chips}>
          {token.scopes.map((scope) => (
            <Chip key={scope}>{t(`tokens.scope.${scope}`)}</Chip>
          ))}
        </span>
      </td>
      <td className={`${pages.nowrap} ${pages.optional}`}>{token.mine ? t("tokens.you") : token.person}</td>
      <td className={`${pages.nowrap} ${pages.optional}`}>
        {token.last_used_at ? formatAgo(token.last_used_at, now) : t("tokens.never")}
      </td>
      <td className={pages.nowrap}>{token.expired ? t("tokens.expired") : formatMoment(token.expires_at)}</td>
      <td>
        <Button
          size="xs"
          variant="default"
          c="var(--error)"
          aria-label={t("tokens.revokeLabel", { name: token.name })}
          onClick={revoke}
        >
          {t("tokens.revoke")}
        </Button>
      </td>
    </tr>
  );
}

function TokenTable({ tokens, choose }: { tokens: Token[]; choose: (token: Token) => void }) {
  const { t } = useTranslation();
  const now = useNow(15_000);
  return (
    <Panel className={pages.scroll}>
      <table className={pages.table}>
        <thead>
          <tr>
            {COLUMNS.map((column) => (
              <th key={column} scope="col" className={OPTIONAL.has(column) ? pages.optional : undefined}>
                <span className={column === "act" ? "visually-hidden" : undefined}>{t(`tokens.column.${column}`)}</span>
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {tokens.map((token) => (
            <Row key={token.id} token={token} now={now} revoke={() => choose(token)} />
          ))}
        </tbody>
      </table>
    </Panel>
  );
}

interface AskProps {
  slug: string;
  token: Token;
  onClose: () => void;
  /** Who has the focus when the token and this question are gone. */
  afterwards: () => HTMLElement | null;
}

export function AskRevoke({ slug, token, onClose, afterwards }: AskProps) {
  const { t } = useTranslation();
  const goOnElsewhere = useReturnFocus(afterwards);
  const revoke = useRevokeToken(slug, useTellUnseen());
  const done = () => {
    notifications.show({ message: t("tokens.revoked", { name: token.name }) });
    goOnElsewhere();
    onClose();
  };
  return (
    <Modal opened onClose={onClose} title={t("tokens.revokeAsk", { name: token.name })} size={440}>
      <div className={pages.form}>
        <p>{t("tokens.revokeText")}</p>
        {revoke.error ? <p role="alert">{problemText(revoke.error, t("shell.problem.screen"))}</p> : null}
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose} data-autofocus>
            {t("tokens.keep")}
          </Button>
          <Button color="red.9" loading={revoke.isPending} onClick={() => revoke.mutate(token, { onSuccess: done })}>
            {t("tokens.revoke")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

export function TokensPage() {
  const { slug = "" } = useParams();
  const secrets = useShownOnce<MadeToken>();
  return (
    <>
      <TokensOfSite key={slug} slug={slug} onMade={secrets.show} />
      {secrets.shown ? <TokenShown key={secrets.shown.id} token={secrets.shown} onClose={secrets.next} /> : null}
    </>
  );
}

function TokensOfSite({ slug, onMade }: { slug: string; onMade: (token: MadeToken) => void }) {
  const { t } = useTranslation();
  const site = useSite(slug);
  const tokens = useTokens(slug);
  const [making, setMaking] = useState(false);
  const [ending, setEnding] = useState<Token | null>(null);
  const intro = useRef<HTMLParagraphElement>(null);
  const problem = missing(site, tokens);
  const begin = (
    <Button leftSection={<Plus size={16} aria-hidden="true" />} onClick={() => setMaking(true)}>
      {t("tokens.new")}
    </Button>
  );
  return (
    <PageShell title={t("tokens.title")} actions={tokens.data?.length ? begin : null}>
      <SettingsTabs slug={slug} role={site.data?.role} />
      <div className={pages.stack}>
        <p ref={intro} className={styles.intro} tabIndex={-1}>
          {t("tokens.intro")}
        </p>
        {problem ? (
          <LoadProblem error={problem} again={() => void Promise.all([site.refetch(), tokens.refetch()])} />
        ) : null}
        {tokens.isPending ? <TableSkeleton /> : null}
        {tokens.data?.length ? <TokenTable tokens={tokens.data} choose={setEnding} /> : null}
        {tokens.data?.length === 0 ? (
          <Panel>
            <EmptyState icon={<KeyRound size={20} />} title={t("tokens.none")} text={t("tokens.noneText")}>
              {begin}
            </EmptyState>
          </Panel>
        ) : null}
      </div>
      {making && site.data ? <NewToken site={site.data} onMade={onMade} onClose={() => setMaking(false)} /> : null}
      {ending ? (
        <AskRevoke slug={slug} token={ending} onClose={() => setEnding(null)} afterwards={() => intro.current} />
      ) : null}
    </PageShell>
  );
}
